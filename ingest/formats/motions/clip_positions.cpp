#include "ingest/formats/motions/clip_positions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

constexpr double farthest = 1e6;  // metres: float32 stays exact enough far beyond any room

/// One clip of an array, body by body.
class Reading {
  public:
    Reading(const JointArray& array, std::uint64_t clip, const PositionsRequest& request)
        : array_(array),
          clip_(clip),
          request_(request),
          joints_(array.joints()),
          first_(std::min(request.start, array.frames())),
          frames_(std::min(request.end.value_or(array.frames()), array.frames()) - first_),
          raw_(joints_ * 3),
          pose_(joints_ * 3),
          body_(joints_ * 3) {}

    std::variant<ClipPositions, Rejection> read() {
        if (frames_ == 0)
            return dropped(
                fmt::format("the labels cut out frames {} on of {}", request_.start, array_.frames()));
        if (array_.persons() == request_.persons && read_all_seen()) return std::move(out_);
        return read_with_gaps();
    }

  private:
    static Rejection broken(std::string reason) { return {Rejection::Kind::broken, std::move(reason)}; }
    static Rejection dropped(std::string reason) { return {Rejection::Kind::dropped, std::move(reason)}; }

    /// pose_ of a body, in metres and upright. False where a number is missing or all are zero.
    bool load(std::uint64_t frame, std::uint64_t person) {
        array_.pose(clip_, first_ + frame, person, raw_.data());
        int any = 0, no_number = 0;  // without branches or sums in order, so that it runs in vectors
        for (const double x : raw_) {
            any |= x != 0;
            no_number |= !(x - x == 0);
        }
        for (std::size_t d = 0; d < 3; ++d) {
            const int axis = request_.axes[d];
            const double factor = axis < 0 ? -request_.scale : request_.scale;
            const double* from = raw_.data() + std::abs(axis) - 1;
            for (std::size_t j = 0; j < joints_; ++j) pose_[3 * j + d] = factor * from[3 * j];
        }
        return any && !no_number;
    }

    /// Straight from the array; false, and nothing done, where not every body is whole in every frame.
    bool read_all_seen() {
        begin();
        for (std::uint64_t t = 0; t < frames_; ++t)
            for (std::uint64_t p = 0; p < request_.persons; ++p)
                if (!load(t, p) || !within_reach(pose_.data()) || !add(pose_.data(), p)) return false;
        finish();
        return true;
    }

    std::variant<ClipPositions, Rejection> read_with_gaps() {
        const auto persons = array_.persons();
        std::vector<double> all(frames_ * persons * joints_ * 3);
        std::vector<bool> seen(frames_ * persons, false);  // any of the body
        for (std::uint64_t t = 0; t < frames_; ++t)
            for (std::uint64_t p = 0; p < persons; ++p) {
                load(t, p);
                double* body = &all[(t * persons + p) * joints_ * 3];
                std::copy(pose_.begin(), pose_.end(), body);
                if (const auto fault = check(body, t); !fault.empty()) return broken(fault);
                seen[t * persons + p] = body_seen(body);
            }
        if (array_.has_clips()) cut_padding(seen, persons);
        const auto kept = most_seen(seen, persons);
        if (kept.empty()) return broken("no number in it: nobody is seen");
        if (kept.size() < request_.persons)
            return dropped(fmt::format("{} of {} persons seen", kept.size(), request_.persons));
        for (const auto p : kept)
            if (const auto fault = fill(all, persons, p); !fault.empty()) return broken(fault);
        begin();
        for (std::uint64_t t = 0; t < frames_; ++t)
            for (std::size_t i = 0; i < kept.size(); ++i) add(&all[(t * persons + kept[i]) * joints_ * 3], i);
        finish();
        out_.filled = true;
        return std::move(out_);
    }

    bool within_reach(const double* body) const {
        int beyond = 0;
        for (std::size_t i = 0; i < joints_ * 3; ++i) beyond |= !(std::abs(body[i]) < farthest);
        return !beyond;
    }

    std::string check(double* body, std::uint64_t frame) const {
        for (std::size_t j = 0; j < joints_; ++j)
            for (std::size_t d = 0; d < 3; ++d)
                if (const double x = body[3 * j + d]; !std::isnan(x) && !(std::abs(x) < farthest))
                    return fmt::format("frame {}: {} is at {:.6g} m; see --scale", first_ + frame,
                                       in_quotes(request_.topology->names[j]), x);
        if (std::all_of(body, body + joints_ * 3, [](double x) { return x == 0; }))
            std::fill(body, body + joints_ * 3, std::nan(""));
        return {};
    }

    bool joint_seen(const double* joint) const {
        return !std::isnan(joint[0]) && !std::isnan(joint[1]) && !std::isnan(joint[2]);
    }
    bool body_seen(const double* body) const {
        for (std::size_t j = 0; j < joints_; ++j)
            if (joint_seen(body + 3 * j)) return true;
        return false;
    }

    void cut_padding(const std::vector<bool>& seen, std::uint64_t persons) {
        const auto anybody = [&](std::uint64_t t) {
            for (std::uint64_t p = 0; p < persons; ++p)
                if (seen[t * persons + p]) return true;
            return false;
        };
        while (frames_ > 1 && !anybody(frames_ - 1)) --frames_;
    }

    /// At most as many as are wanted, in the array's order.
    std::vector<std::uint64_t> most_seen(const std::vector<bool>& seen, std::uint64_t persons) const {
        std::vector<std::uint64_t> frames_seen(persons, 0), order;
        for (std::uint64_t t = 0; t < frames_; ++t)
            for (std::uint64_t p = 0; p < persons; ++p) frames_seen[p] += seen[t * persons + p];
        for (std::uint64_t p = 0; p < persons; ++p)
            if (frames_seen[p] > 0) order.push_back(p);
        std::stable_sort(order.begin(), order.end(),
                         [&](auto a, auto b) { return frames_seen[a] > frames_seen[b]; });
        if (order.size() > request_.persons) order.resize(request_.persons);
        return order;
    }

    /// Fills in what was not seen of a person, joint by joint. The name of a joint that never was.
    std::string fill(std::vector<double>& all, std::uint64_t persons, std::uint64_t person) const {
        const auto at = [&](std::uint64_t t, std::size_t j) {
            return &all[((t * persons + person) * joints_ + j) * 3];
        };
        for (std::size_t j = 0; j < joints_; ++j) {
            std::uint64_t before = frames_, t = 0;
            for (; t < frames_; ++t) {
                if (!joint_seen(at(t, j))) continue;
                const auto gap = before == frames_ ? 0 : before + 1;
                for (auto g = gap; g < t; ++g)
                    between(before == frames_ ? at(t, j) : at(before, j), at(t, j),
                            before == frames_
                                ? 0
                                : static_cast<double>(g - before) / static_cast<double>(t - before),
                            at(g, j));
                before = t;
            }
            if (before == frames_)
                return fmt::format("{} is never seen", in_quotes(request_.topology->names[j]));
            for (auto g = before + 1; g < frames_; ++g) std::copy(at(before, j), at(before, j) + 3, at(g, j));
        }
        return {};
    }

    static void between(const double* a, const double* b, double weight, double* to) {
        for (std::size_t d = 0; d < 3; ++d) to[d] = a[d] + (b[d] - a[d]) * weight;
    }

    void begin() {
        out_ = {};
        out_.values.reserve(frames_ * request_.persons * joints_ *
                            3);  // zeros there would cost as much as reading
        lengths_.assign(request_.persons * joints_, 0);
    }

    /// The next body, of person `p` of those kept.
    bool add(const double* pose, std::size_t p) {
        if (out_.values.empty()) std::copy(pose, pose + 3, origin_.begin());
        const auto& parents = request_.topology->parents;
        double* length = &lengths_[p * joints_];
        float* to = body_.data();
        for (std::size_t j = 0; j < joints_; ++j, to += 3) {
            const double* joint = pose + 3 * j;
            const double* parent = parents[j] < 0 ? origin_.data() : pose + 3 * parents[j];
            if (request_.limbs) {
                for (std::size_t d = 0; d < 3; ++d) to[d] = static_cast<float>(joint[d] - parent[d]);
                continue;
            }
            for (std::size_t d = 0; d < 3; ++d) to[d] = static_cast<float>(joint[d] - origin_[d]);
            if (parents[j] >= 0)
                length[j] += std::hypot(joint[0] - parent[0], joint[1] - parent[1], joint[2] - parent[2]);
        }
        out_.values.insert(out_.values.end(), body_.begin(), body_.end());
        return true;
    }

    void finish() {
        out_.frames = static_cast<std::uint32_t>(frames_);
        for (const double sum : lengths_)
            out_.bone_length.push_back(static_cast<float>(sum / static_cast<double>(frames_)));
    }

    const JointArray& array_;
    std::uint64_t clip_;
    const PositionsRequest& request_;
    std::size_t joints_;
    std::uint64_t first_, frames_;
    std::vector<double> raw_, pose_;
    std::array<double, 3> origin_{};
    std::vector<double> lengths_;
    std::vector<float> body_;  ///< (joints, 3)
    ClipPositions out_;
};

}  // namespace

std::variant<ClipPositions, Rejection> read_positions(const JointArray& array, std::uint64_t clip,
                                                      const PositionsRequest& request) {
    return Reading(array, clip, request).read();
}

}  // namespace actformer::ingest
