#include "ingest/export/rotations.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace actformer::ingest {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double no_length = 1e-9;  // metres: too short to have a direction

Vector3d vector(const Point& p) {
    return {p[0], p[1], p[2]};
}

Point point(const Vector3d& v) {
    return {v[0], v[1], v[2]};
}

/// Directions of one joint's children: in the rest pose, and in a frame.
struct Directions {
    std::vector<Vector3d> rest, now;

    void clear() {
        rest.clear();
        now.clear();
    }
};

/// The smallest rotation that brings one direction of length 1 to another; any of those where they are opposite. Eigen's
/// Quaternion::FromTwoVectors has a singular value decomposition for opposite ones, which takes a compiler ten seconds.
Quaterniond smallest_rotation(const Vector3d& from, const Vector3d& to) {
    constexpr double nothing = 1e-24;  // the square of many roundings, and of a turn that nobody sees
    const Vector3d sum = from + to;    // exact where they are nearly opposite, as 1 + cosine is not
    if (sum.squaredNorm() < nothing) {
        const Vector3d axis = from.unitOrthogonal();
        return {0, axis.x(), axis.y(), axis.z()};
    }
    const Vector3d axis = from.cross(sum);
    return Quaterniond(sum.squaredNorm() / 2, axis.x(), axis.y(), axis.z()).normalized();
}

/// The rotation with the least sum of squared distances between what it makes of `rest` and `now`; the smallest of several.
Quaterniond best_rotation(const Directions& of) {
    if (of.rest.size() == 1) return smallest_rotation(of.rest[0], of.now[0]);
    Matrix3d h = Matrix3d::Zero();
    for (std::size_t i = 0; i < of.rest.size(); ++i) h += of.now[i] * of.rest[i].transpose();
    const Eigen::JacobiSVD<Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const auto& u = svd.matrixU();
    const auto& v = svd.matrixV();
    constexpr double on_a_line =
        1e-4;  // a plane seen at less than half a degree would turn with every rounding
    if (svd.singularValues()[1] < on_a_line * svd.singularValues()[0])
        return smallest_rotation(v.col(0), u.col(0));
    const double mirrored = (u * v.transpose()).determinant() < 0 ? -1 : 1;
    return Quaterniond(u * Vector3d(1, 1, mirrored).asDiagonal() * v.transpose()).normalized();
}

class Fit {
  public:
    Fit(const Topology& topology, std::span<const Point> joints)
        : topology_(topology),
          joints_(joints),
          order_(topology.order()),
          children_(topology.joints()),
          world_(topology.joints()) {
        for (std::size_t j = 1; j < topology.joints(); ++j) children_[topology.parents[j]].push_back(j);
        motion_.topology = topology;
        motion_.frames = static_cast<std::uint32_t>(joints.size() / topology.joints());
        motion_.rotation.resize(joints.size());
        motion_.position.resize(joints.size());
    }

    void set_rest(std::span<const Point> pose) {
        const auto lengths = mean_lengths();
        motion_.rest.assign(topology_.joints(), Point{});
        for (std::size_t j = 1; j < topology_.joints(); ++j) {
            auto direction = vector(pose[j]);
            if (direction.norm() < no_length) direction = Vector3d::UnitY();
            motion_.rest[j] = point(direction.normalized() * lengths[j]);
        }
    }

    void turn_all() {
        for (std::size_t t = 0; t < motion_.frames; ++t)
            for (const auto j : order_) turn(t, j);
    }

    /// Gives brothers the place that they have in the mean over the frames, at the length they have.
    void settle_brothers() {
        const auto k = topology_.joints();
        std::vector<Vector3d> mean(k, Vector3d::Zero());
        for (std::size_t i = 0; i < motion_.position.size(); ++i) mean[i % k] += vector(motion_.position[i]);
        for (std::size_t j = 1; j < k; ++j) {
            const bool has_brothers = children_[topology_.parents[j]].size() > 1;
            if (has_brothers && mean[j].norm() > no_length)
                motion_.rest[j] = point(mean[j].normalized() * vector(motion_.rest[j]).norm());
        }
    }

    SkeletonMotion finished() {
        const auto k = topology_.joints();
        motion_.slides.assign(k, false);
        motion_.slides[0] = true;
        for (std::size_t i = 0; i < motion_.position.size(); ++i)
            if ((vector(motion_.position[i]) - vector(motion_.rest[i % k])).norm() > rigid_within)
                motion_.slides[i % k] = true;
        for (std::size_t i = 0; i < motion_.position.size(); ++i)
            if (!motion_.slides[i % k]) motion_.position[i] = motion_.rest[i % k];
        return std::move(motion_);
    }

  private:
    Vector3d bone(std::size_t frame, std::size_t joint) const {
        const auto* body = &joints_[frame * topology_.joints()];
        return vector(body[joint]) - vector(body[topology_.parents[joint]]);
    }

    std::vector<double> mean_lengths() const {
        std::vector<double> lengths(topology_.joints(), 0);
        for (std::size_t t = 0; t < motion_.frames; ++t)
            for (std::size_t j = 1; j < lengths.size(); ++j) lengths[j] += bone(t, j).norm();
        for (auto& length : lengths) length /= motion_.frames;
        return lengths;
    }

    void turn(std::size_t frame, std::size_t joint) {
        const auto k = topology_.joints();
        const int parent = topology_.parents[joint];
        const Quaterniond above = parent < 0 ? Quaterniond::Identity() : world_[parent];
        const auto at = frame * k + joint;
        motion_.position[at] = parent < 0 ? joints_[at] : point(above.conjugate() * bone(frame, joint));

        directions_.clear();
        for (const auto child : children_[joint]) {
            const Vector3d now = above.conjugate() * bone(frame, child), rest = vector(motion_.rest[child]);
            if (now.norm() < no_length || rest.norm() < no_length) continue;
            directions_.now.push_back(now.normalized());
            directions_.rest.push_back(rest.normalized());
        }
        const auto* before = frame > 0 ? &motion_.rotation[at - k] : nullptr;
        auto own = before ? Quaterniond(before->w, before->x, before->y, before->z) : Quaterniond::Identity();
        if (!directions_.now.empty()) {
            auto next = best_rotation(directions_);
            if (before && next.dot(own) < 0) next.coeffs() = -next.coeffs();
            own = next;
        }
        motion_.rotation[at] = {own.w(), own.x(), own.y(), own.z()};
        world_[joint] = (above * own).normalized();
    }

    const Topology& topology_;
    std::span<const Point> joints_;
    std::vector<std::uint32_t> order_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<Quaterniond> world_;  ///< (K) rotations in the world, in the frame at hand
    Directions directions_;
    SkeletonMotion motion_;
};

}  // namespace

SkeletonMotion minimal_twist(const Topology& topology, std::span<const Point> joints,
                             std::span<const Point> pose) {
    Fit fit(topology, joints);
    fit.set_rest(pose);
    fit.turn_all();
    fit.settle_brothers();
    fit.turn_all();
    return fit.finished();
}

}  // namespace actformer::ingest
