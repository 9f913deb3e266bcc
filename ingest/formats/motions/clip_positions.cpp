#include "ingest/formats/motions/clip_positions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>

#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

constexpr double farthest = 1e6;  // metres: float32 stays exact enough far beyond any room
constexpr std::uint64_t bodies_at_once =
    16;  // of 25 joints: 10 kB, which the nearest cache holds a few times

/// Frames are counted in 32 bits from here on.
std::uint32_t countable(std::uint64_t frames) {
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(frames, std::numeric_limits<std::uint32_t>::max()));
}

/// Adds the lengths of a body's limbs to `lengths`, (joints).
template <typename Number>
void add_limb_lengths(const Number* pose, const Topology& topology, double* lengths) {
    for (std::size_t j = 1; j < topology.joints(); ++j) {
        const Number *joint = pose + 3 * j, *parent = pose + std::ptrdiff_t{3} * topology.parents[j];
        const auto along = [&](std::size_t d) { return double{joint[d]} - double{parent[d]}; };
        lengths[j] += std::hypot(along(0), along(1), along(2));
    }
}

/// Sums over `frames` frames.
std::vector<float> means(const std::vector<double>& sums, std::uint64_t frames) {
    std::vector<float> out;
    for (const double sum : sums) out.push_back(static_cast<float>(sum / static_cast<double>(frames)));
    return out;
}

/// One clip of an array, some bodies at a time. A body is a person in a frame; the persons of a frame follow one another.
class Reading {
  public:
    Reading(const JointArray& array, std::uint64_t clip, const PositionsRequest& request)
        : array_(array),
          clip_(clip),
          request_(request),
          joints_(array.joints()),
          body_(joints_ * 3),
          span_(frame_span(request.start, request.end, countable(array.frames()))),
          first_(span_.first),
          frames_(span_.last - std::min(span_.first, span_.last)),
          raw_(bodies_at_once * body_),
          pose_(bodies_at_once * body_),
          placed_(bodies_at_once * body_) {}

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

    /// pose_ of bodies of the array, in metres and upright.
    void load(std::uint64_t body, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto frame = (body + i) / array_.persons(), person = (body + i) % array_.persons();
            array_.pose(clip_, first_ + frame, person, &raw_[i * body_]);
        }
        turn(count * body_);
    }

    /// False where a number of the bodies is missing or beyond reach, or all of a body are zero.
    template <typename Number>
    bool all_seen(const Number* poses, std::uint64_t count) const {
        std::conditional_t<sizeof(Number) == 4, std::int32_t, std::int64_t> beyond =
            0;  // as wide as the numbers and without branches: it runs in vectors
        for (std::size_t i = 0; i < count * body_; ++i)
            beyond |= !(std::abs(poses[i]) < static_cast<Number>(farthest));  // NaN is
        if (beyond) return false;
        for (std::uint64_t i = 0; i < count; ++i)
            if (all_zero(poses + i * body_)) return false;
        return true;
    }

    template <typename Number>
    bool all_zero(const Number* body) const {
        return std::all_of(body, body + body_, [](Number x) { return x == 0; });
    }

    /// So many numbers of pose_ from raw_. All three axes in one loop, whose stores then follow one another.
    void turn(std::size_t numbers) {
        const auto factor = [this](std::size_t d) {
            return request_.axes[d] < 0 ? -request_.scale : request_.scale;
        };
        const auto along = [this](std::size_t d) { return raw_.data() + std::abs(request_.axes[d]) - 1; };
        const double by_x = factor(0), by_y = factor(1), by_z = factor(2);
        const double *x = along(0), *y = along(1), *z = along(2);
        double* to = pose_.data();
        for (std::size_t i = 0; i < numbers; i += 3) {
            to[i] = by_x * x[i];
            to[i + 1] = by_y * y[i];
            to[i + 2] = by_z * z[i];
        }
    }

    /// Straight from the array; false, and nothing done, where not every body is whole in every frame.
    bool read_all_seen() {
        begin();
        const auto* upright = in_metres_upright() ? array_.as_it_lies(clip_, first_) : nullptr;
        const auto bodies = frames_ * request_.persons;
        const auto taken = [&](const auto* poses, std::uint64_t count) {
            if (!all_seen(poses, count)) return false;
            add(poses, count);
            return true;
        };
        for (std::uint64_t body = 0; body < bodies; body += bodies_at_once) {
            const auto count = std::min(bodies_at_once, bodies - body);
            if (!upright) load(body, count);
            if (!(upright ? taken(upright + body * body_, count) : taken(pose_.data(), count))) return false;
        }
        finish();
        return true;
    }

    bool in_metres_upright() const {
        return request_.scale == 1 && request_.axes == std::array<int, 3>{1, 2, 3};
    }

    std::variant<ClipPositions, Rejection> read_with_gaps() {
        const auto persons = array_.persons();
        std::vector<double> all(frames_ * persons * joints_ * 3);
        std::vector<bool> seen(frames_ * persons, false);  // any of the body
        for (std::uint64_t t = 0; t < frames_; ++t)
            for (std::uint64_t p = 0; p < persons; ++p) {
                load(t * persons + p, 1);
                double* body = &all[(t * persons + p) * body_];
                std::copy_n(pose_.begin(), body_, body);
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
            for (std::size_t i = 0; i < kept.size(); ++i) add(&all[(t * persons + kept[i]) * body_], 1);
        finish();
        out_.filled = filled_;
        return std::move(out_);
    }

    std::string check(double* body, std::uint64_t frame) const {
        for (std::size_t j = 0; j < joints_; ++j)
            for (std::size_t d = 0; d < 3; ++d)
                if (const double x = body[3 * j + d]; !std::isnan(x) && !(std::abs(x) < farthest))
                    return fmt::format("frame {}: {} is at {:.6g} m; see --scale", first_ + frame,
                                       in_quotes(request_.topology->names[j]), x);
        if (all_zero(body)) std::fill(body, body + body_, std::nan(""));
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

    /// At most as many as are wanted, those seen most first.
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
    std::string fill(std::vector<double>& all, std::uint64_t persons, std::uint64_t person) {
        const auto at = [&](std::uint64_t t, std::size_t j) {
            return &all[((t * persons + person) * joints_ + j) * 3];
        };
        for (std::size_t j = 0; j < joints_; ++j) {
            std::uint64_t before = frames_, t = 0;
            for (; t < frames_; ++t) {
                if (!joint_seen(at(t, j))) continue;
                const auto gap = before == frames_ ? 0 : before + 1;
                filled_ = filled_ || gap < t;
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
            filled_ = filled_ || before + 1 < frames_;
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
        added_ = 0;
    }

    /// The next bodies, persons of those kept.
    template <typename Number>
    void add(const Number* poses, std::uint64_t count) {
        if (out_.values.empty()) std::copy(poses, poses + 3, origin_.begin());
        for (std::uint64_t i = 0; i < count; ++i) {
            place(poses + i * body_, &placed_[i * body_]);
            if (!request_.limbs)
                add_limb_lengths(poses + i * body_, *request_.topology,
                                 &lengths_[added_++ % request_.persons * joints_]);
        }
        out_.values.insert(out_.values.end(), placed_.begin(),
                           placed_.begin() + static_cast<std::ptrdiff_t>(count * body_));
    }

    /// Joints from their parents or from the origin, joint 0 being the root.
    template <typename Number>
    void place(const Number* pose, float* to) const {
        const int* parents = request_.topology->parents.data();
        put(pose, origin_.data(), to);
        if (request_.limbs)
            for (std::size_t j = 1; j < joints_; ++j)
                put(pose + 3 * j, pose + std::ptrdiff_t{3} * parents[j], to + 3 * j);
        else
            for (std::size_t j = 1; j < joints_; ++j) put(pose + 3 * j, origin_.data(), to + 3 * j);
    }

    /// The difference of two float32 is the same whether it is rounded once or by way of a double (Figueroa 1995).
    template <typename Number, typename From>
    static void put(const Number* joint, const From* from, float* to) {
        for (std::size_t d = 0; d < 3; ++d) to[d] = static_cast<float>(joint[d] - from[d]);
    }

    void finish() {
        out_.frames = static_cast<std::uint32_t>(frames_);
        out_.span = span_;
        out_.bone_length = means(lengths_, frames_);
    }

    const JointArray& array_;
    std::uint64_t clip_;
    const PositionsRequest& request_;
    std::size_t joints_, body_;  ///< of a body: its joints and its numbers
    FrameSpan span_;
    std::uint64_t first_, frames_;
    std::vector<double> raw_, pose_;  ///< (bodies at once, joints, 3)
    std::vector<float> placed_;       ///< as those
    std::array<double, 3> origin_{};
    std::vector<double> lengths_;  ///< (persons, joints)
    std::uint64_t added_ = 0;      ///< bodies whose lengths are among these
    bool filled_ = false;          ///< any gap
    ClipPositions out_;
};

}  // namespace

std::vector<float> mean_limb_lengths(const std::vector<float>& positions, std::uint32_t persons,
                                     const Topology& topology) {
    const auto joints = topology.joints();
    std::vector<double> sums(persons * joints);
    for (std::size_t body = 0; body < positions.size() / (joints * 3); ++body)
        add_limb_lengths(&positions[body * joints * 3], topology, &sums[body % persons * joints]);
    return means(sums, positions.size() / (sums.size() * 3));
}

std::variant<ClipPositions, Rejection> read_positions(const JointArray& array, std::uint64_t clip,
                                                      const PositionsRequest& request) {
    return Reading(array, clip, request).read();
}

}  // namespace actformer::ingest
