#include "ingest/formats/rotational/rotational_clip.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "ingest/smpl/body_file.hpp"

namespace actformer::ingest {
namespace {

using Place = std::array<double, 3>;
using Places = std::array<Place, smpl_joints>;

constexpr double least_length =
    1e-4;  // added to a limb's length before it is divided by it, as for all limbs

/// Every joint relative to its parent, turned as in the world; the root's place in the body.
Places bones_of(const Quaternion* pose, const std::vector<double>& offsets) {
    std::array<Rotation, smpl_joints> turned;
    Places bones{};
    for (std::size_t j = 0; j < smpl_joints; ++j) {
        const int parent = smpl24_parents[j];
        const double* offset = &offsets[3 * j];
        const auto own = matrix_of(pose[j]);
        turned[j] = parent < 0 ? own : product(turned[static_cast<std::size_t>(parent)], own);
        for (std::size_t d = 0; d < 3; ++d) {
            if (parent < 0) {
                bones[j][d] = offset[d];
                continue;
            }
            const double* row = &turned[static_cast<std::size_t>(parent)][3 * d];
            bones[j][d] = row[0] * offset[0] + row[1] * offset[1] + row[2] * offset[2];
        }
    }
    return bones;
}

/// The first two rows of every rotation's matrix.
void write_rotations(const Quaternion* pose, float* to) {
    for (std::size_t j = 0; j < smpl_joints; ++j, to += 6) {
        const auto m = matrix_of(pose[j]);
        for (std::size_t i = 0; i < 6; ++i) to[i] = static_cast<float>(m[i]);
    }
}

void write_limbs(const Places& bones, float* to) {
    for (std::size_t j = 1; j < smpl_joints; ++j) {
        const auto& bone = bones[j];
        const double length =
            std::sqrt(bone[0] * bone[0] + bone[1] * bone[1] + bone[2] * bone[2]) + least_length;
        for (std::size_t d = 0; d < 3; ++d) to[3 * j + d] = static_cast<float>(bone[d] / length);
    }
}

/// Relative to the root.
void write_places(const Places& bones, float* to) {
    Places at{};
    for (std::size_t j = 1; j < smpl_joints; ++j)
        for (std::size_t d = 0; d < 3; ++d) {
            at[j][d] = at[static_cast<std::size_t>(smpl24_parents[j])][d] + bones[j][d];
            to[3 * j + d] = static_cast<float>(at[j][d]);
        }
}

}  // namespace

std::vector<Option> RotationalOptions::list() {
    return {
        Option("--representation",
               "What rotations become: rot6d (default), or limb or xyz, of the rest skeleton's joints", "REP",
               &representation)
            .one_of({"rot6d", "limb", "xyz"}),
        Option(
            "--body",
            "SMPL's model file, as SMPL_NEUTRAL.pkl or .npz: the rest skeleton is its mean body's, whatever "
            "shapes the recordings tell (default: a generic skeleton)",
            "FILE", &body)};
}

RotationalTarget RotationalOptions::target() const {
    return {Representation::named(representation.empty() ? "rot6d" : representation, "--representation"),
            body.empty() ? generic_skeleton() : read_smpl_body(body).rest(),
            !body.empty()               ? "--body"
            : representation == "rot6d" ? "--representation rot6d"
                                        : ""};
}

Representation RotationalTarget::of_joints() const {
    if (!of_rotations_alone.empty())
        throw Error("{} is of rotations, and joints are taken; leave it out, or give --from rotations",
                    of_rotations_alone);
    return representation == Representation::xyz ? Representation::xyz : Representation::limb;
}

std::string RotationalTarget::text() const {
    return fmt::format("{} of the skeleton {} ({})", representation.name(), in_quotes(skeleton.source),
                       fmt::join(skeleton.offsets, " "));
}

DatasetHeader RotationalTarget::header(const std::string& name) const {
    DatasetHeader header;
    header.name = name;
    header.representation = representation;
    header.topology = smpl24();
    if (representation == Representation::rot6d) header.rest = skeleton.rest();
    header.origin = {DataOrigin::Kind::recorded, skeleton.source};
    return header;
}

RotationalTrack::RotationalTrack(const RotationalMotion& motion, const RotationalTarget& target)
    : representation_(target.representation),
      frames_(motion.frames),
      nodes_(target.representation.nodes(smpl24())),
      way_(motion.translation) {
    const std::size_t row = std::size_t{nodes_} * representation_.numbers();
    values_.resize(frames_ * row);
    for (std::size_t t = 0; t < frames_; ++t) {
        float* to = &values_[t * row];
        if (representation_ == Representation::rot6d) {
            write_rotations(motion.pose(t), to);
            continue;
        }
        const auto bones = bones_of(motion.pose(t), target.skeleton.offsets);
        for (std::size_t d = 0; d < 3; ++d) way_[3 * t + d] += bones[0][d];
        representation_ == Representation::limb ? write_limbs(bones, to) : write_places(bones, to);
    }
}

std::unique_ptr<RotationalClip> RotationalTrack::cut(std::uint32_t first, std::uint32_t last) const {
    const std::size_t numbers = representation_.numbers(), row = nodes_ * numbers;
    auto clip = std::make_unique<RotationalClip>();
    clip->frames = last - first;
    clip->values.assign(values_.begin() + static_cast<std::ptrdiff_t>(first * row),
                        values_.begin() + static_cast<std::ptrdiff_t>(last * row));
    Place mean{};
    for (std::size_t i = 3 * std::size_t{first}; i < 3 * std::size_t{last}; ++i)
        mean[i % 3] += way_[i] / static_cast<double>(clip->frames);
    const auto moving = representation_.moving(nodes_);
    for (std::size_t t = 0; t < clip->frames; ++t)
        for (std::size_t node = moving.first; node < moving.first + moving.count; ++node) {
            float* to = &clip->values[t * row + node * numbers];
            for (std::size_t d = 0; d < 3; ++d)
                to[d] = static_cast<float>(to[d] + (way_[3 * (first + t) + d] - mean[d]));
        }
    return clip;
}

kernels::CleanedBatch gathered(std::span<const std::unique_ptr<RawClip>> clips,
                               const RotationalTarget& target, std::vector<std::uint32_t>& frames) {
    const auto motion = std::make_shared<std::vector<float>>();
    std::size_t numbers = 0;
    for (const auto& raw : clips) numbers += static_cast<const RotationalClip&>(*raw).values.size();
    motion->reserve(numbers);
    kernels::CleanedBatch out;
    frames.clear();
    const auto lengths = rest_lengths(target.skeleton.offsets);
    for (const auto& raw : clips) {
        const auto& clip = static_cast<const RotationalClip&>(*raw);
        motion->insert(motion->end(), clip.values.begin(), clip.values.end());
        out.bone_length.insert(out.bone_length.end(), lengths.begin(), lengths.end());
        frames.push_back(clip.frames);
    }
    out.motion = *motion;
    out.memory = motion;
    return out;
}

}  // namespace actformer::ingest
