#include "ingest/formats/rotational/rotational_motion.hpp"

#include <algorithm>
#include <limits>

#include "base/error.hpp"

namespace actformer::ingest {
namespace {

/// A frame of the file, kept while it is asked for again.
class Frame {
  public:
    explicit Frame(const RotationVectors& file) : file_(file), vectors_(file.joints * 3) {}

    void read(std::uint64_t frame) {
        if (frame == at_) return;
        file_.read(frame, vectors_.data(), translation.data());
        const auto finite = [](double x) { return std::isfinite(x); };
        if (!std::ranges::all_of(vectors_, finite) || !std::ranges::all_of(translation, finite))
            throw Error("frame {}: a number that is not finite", frame);
        at_ = frame;
        for (std::size_t j = 0; j < std::min(file_.joints, smpl_joints); ++j)
            rotations[j] = of_rotation_vector(&vectors_[3 * j]);
    }

    std::array<Quaternion, smpl_joints> rotations;
    std::array<double, 3> translation{};

  private:
    const RotationVectors& file_;
    std::vector<double> vectors_;
    std::uint64_t at_ = std::numeric_limits<std::uint64_t>::max();
};

constexpr std::uint64_t most_frames = std::uint64_t{1} << 20;  // nearly ten hours, and 0.8 GB

RotationalMotion room_for(std::uint64_t frames) {
    if (frames > most_frames) throw Error("{} frames, more than a clip may have", frames);
    RotationalMotion out;
    out.frames = static_cast<std::uint32_t>(frames);
    out.rotations.reserve(frames * smpl_joints);
    out.translation.reserve(frames * 3);
    return out;
}

/// Nearer than this many frames, a time is that of the frame: rates are told to so many digits.
constexpr double same_time = 1e-6;

}  // namespace

RotationalMotion as_recorded(const RotationVectors& file) {
    auto out = room_for(file.frames);
    Frame frame(file);
    for (std::uint64_t t = 0; t < file.frames; ++t) {
        frame.read(t);
        out.rotations.insert(out.rotations.end(), frame.rotations.begin(), frame.rotations.end());
        out.translation.insert(out.translation.end(), frame.translation.begin(), frame.translation.end());
    }
    return out;
}

RotationalMotion resampled(const RotationVectors& file, double from, double to) {
    if (file.frames == 0) return {};
    const double last = static_cast<double>(file.frames - 1), step = from / to;
    auto out = room_for(static_cast<std::uint64_t>(last / step + same_time) + 1);
    Frame before(file), after(file);
    for (std::uint32_t i = 0; i < out.frames; ++i) {
        const double at = std::min(i * step, last), nearest = std::round(at);
        const bool on_frame = std::abs(at - nearest) < same_time;
        const auto frame = static_cast<std::uint64_t>(on_frame ? nearest : at);
        before.read(frame);
        if (on_frame) {
            out.rotations.insert(out.rotations.end(), before.rotations.begin(), before.rotations.end());
            out.translation.insert(out.translation.end(), before.translation.begin(),
                                   before.translation.end());
            continue;
        }
        after.read(frame + 1);
        const double u = at - static_cast<double>(frame);
        for (std::size_t j = 0; j < smpl_joints; ++j)
            out.rotations.push_back(slerp(before.rotations[j], after.rotations[j], u));
        for (std::size_t d = 0; d < 3; ++d)
            out.translation.push_back((1 - u) * before.translation[d] + u * after.translation[d]);
    }
    return out;
}

void turn(RotationalMotion& motion, const Quaternion& by) {
    const auto m = matrix_of(by);
    for (std::size_t t = 0; t < motion.frames; ++t) {
        auto& root = motion.rotations[t * smpl_joints];
        root = by * root;
        double* v = &motion.translation[t * 3];
        const double x = v[0], y = v[1], z = v[2];
        for (std::size_t d = 0; d < 3; ++d) v[d] = m[3 * d] * x + m[3 * d + 1] * y + m[3 * d + 2] * z;
    }
}

}  // namespace actformer::ingest
