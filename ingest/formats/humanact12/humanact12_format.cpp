#include "ingest/formats/humanact12/humanact12_format.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "base/numpy/npy.hpp"
#include "base/pickle/pickle.hpp"
#include "ingest/formats/humanact12/array_name.hpp"
#include "ingest/formats/motions/position_clips.hpp"
#include "ingest/formats/parsed.hpp"
#include "ingest/formats/rotational/pose_rows.hpp"

namespace actformer::ingest {
namespace {

using From = HumanAct12Options::From;

constexpr std::array classes{
    "warm_up", "walk",   "run",  "jump", "drink", "lift_dumbbell", "sit", "eat", "turn steering wheel",
    "phone",   "boxing", "throw"};
constexpr std::size_t published = 1191;  // clips

}  // namespace

/// The pickle's lists, an element a clip.
class HumanAct12Format::Clips {
  public:
    explicit Clips(const PickleValue& file)
        : poses_(file.get("poses")), joints_(file.get("joints3D")), labels_(labels_of(file.get("y"))) {
        if (poses_.size() != joints_.size() || poses_.size() != labels_.size())
            throw Error(
                "'poses' has {} clips, 'joints3D' {} and 'y' {}: their lengths differ; get the file again",
                poses_.size(), joints_.size(), labels_.size());
    }

    std::size_t size() const { return labels_.size(); }

    std::uint32_t label(std::size_t clip) const {
        const auto label = labels_[clip];
        if (!(label >= 0 && label < static_cast<double>(classes.size())))
            throw Error("class {}, none of 0 to {}", label, classes.size() - 1);
        return static_cast<std::uint32_t>(label);
    }

    std::size_t bytes(std::size_t clip) const {
        std::size_t bytes = 0;
        for (const auto& list : {poses_, joints_})
            if (list[clip].is_array()) bytes += list[clip].array().values.size();
        return bytes;
    }

    const NumpyArray& joints(std::size_t clip) const { return joints_[clip].array(); }

    /// In the camera's frame, with the root where the joints have it.
    RotationalMotion motion(std::size_t clip) const {
        const auto poses = smpl_poses(poses_[clip].array(), "poses");
        const NumpyRows joints(this->joints(clip), "joints3D", {smpl_joints, 3});
        if (joints.count() != poses.count())
            throw Error("{} frames of 'poses' and {} of 'joints3D'", poses.count(), joints.count());
        std::vector<double> row(joints.size());
        return motion_of(poses, [&](std::uint64_t frame, double* xyz) {
            joints.read(frame, row.data());
            std::copy_n(row.data(), 3, xyz);
        });
    }

  private:
    static std::vector<double> labels_of(const PickleValue& y) {
        if (y.is_array()) return y.array().all_numbers();
        std::vector<double> labels;
        for (std::size_t i = 0; i < y.size(); ++i) labels.push_back(y[i].real());
        return labels;
    }

    PickleValue poses_, joints_;
    std::vector<double> labels_;
};

void HumanAct12Format::settle() {
    rotations_ = options_.from == From::rotations || (options_.from == From::files && pickles_ > 0);
    from_arrays_ = !rotations_ && arrays_ > 0;
    if (rotations_ && pickles_ == 0)
        throw Error(
            "rotations are in humanact12poses.pkl, and there is no .pkl file; --from joints takes the .npy "
            "files");
    DatasetHeader header;
    if (rotations_) {
        header = options_.target.header(options_.dataset);
    } else {
        header.name = options_.dataset;
        header.topology = smpl24();
        header.representation = options_.target.of_joints();
        header.origin.kind = DataOrigin::Kind::recorded;
    }
    header.fps = options_.fps;
    header.classes.assign(classes.begin(), classes.end());
    header.fields = from_arrays_ ? array_fields() : std::vector<std::string>{"action", "index"};
    datasets_ = {std::move(header)};
    settled_ = true;
}

std::string HumanAct12Format::settings() const {
    const auto what =
        rotations_ ? options_.target.text() : fmt::format("{} of joints", datasets_[0].representation.name());
    return fmt::format("humanact12{}: {} at {} frames a second", options_.published ? ", y down" : "", what,
                       options_.fps);
}

std::vector<std::string> HumanAct12Format::remarks() const {
    if (!from_arrays_ || arrays_ == published) return {};
    return {fmt::format("{} files; HumanAct12 was published with {}", arrays_, published)};
}

std::optional<Rejection> HumanAct12Format::refuse(const RawText& raw) const {
    if (!settled_ || raw.ends_in(".npy") == from_arrays_) return {};
    return Rejection{Rejection::Kind::dropped,
                     raw.ends_in(".npy")
                         ? "joints; the rotations of the .pkl file are taken (--from joints takes these)"
                         : "the joints of the .npy files are taken, and not these"};
}

void HumanAct12Format::read(const RawText& raw, ClipSink& sink) const {
    if (raw.ends_in(".npy")) return sink.take(made_or_broken("", [&] { return parse_array(raw); }));
    try {
        read_pickle(raw, sink);
    } catch (const Error& e) {
        sink.take(Rejection{Rejection::Kind::broken, e.what()});
    }
}

void HumanAct12Format::read_pickle(const RawText& raw, ClipSink& sink) const {
    const Pickle file(raw.text, {}, [&](const char* here) { raw.release(here); });
    const Clips clips(file.root());
    make_in_order(
        clips.size(), sink, [&](std::size_t i) { return clips.bytes(i); },
        [&](std::size_t i) {
            return made_or_broken(fmt::format("clip {}", i), [&] { return make_clip(clips, i); });
        },
        [&](std::size_t bytes) { raw.release_read(bytes); });
}

ParsedClip HumanAct12Format::make_clip(const Clips& clips, std::size_t i) const {
    const auto label = clips.label(i);
    std::unique_ptr<RawClip> clip;
    if (rotations_) {
        auto motion = clips.motion(i);
        if (!options_.published) turn(motion, y_down_to_y_up);
        clip = whole(motion, options_.target);
    } else {
        auto made = position_clip(clips.joints(i), up(), datasets_[0]);
        if (auto* rejection = std::get_if<Rejection>(&made)) return std::move(*rejection);
        clip = std::move(std::get<0>(made));
    }
    clip->name = fmt::format("A{:03}_{:04}", label + 1, i);
    clip->label = label;
    clip->fields = {std::to_string(label + 1), std::to_string(i)};
    return clip;
}

ParsedClip HumanAct12Format::parse_array(const RawText& raw) const {
    const auto name = parse_array_name(raw.stem);
    if (!name)
        return Rejection{Rejection::Kind::broken,
                         "the name is not PssGggRrrFffffTttttAcccc with a class from 01 to 12"};
    auto made = position_clip(read_npy(raw.text), up(), datasets_[0]);
    if (auto* rejection = std::get_if<Rejection>(&made)) return std::move(*rejection);
    auto clip = std::move(std::get<0>(made));
    clip->name = raw.stem;
    clip->label = name->label;
    clip->fields = name->fields;
    return clip;
}

kernels::CleanedBatch HumanAct12Format::clean(kernels::Device& device, std::size_t dataset,
                                              std::span<const std::unique_ptr<RawClip>> clips,
                                              std::vector<std::uint32_t>& frames) const {
    return rotations_ ? gathered(clips, options_.target, frames)
                      : cleaned(device, clips, datasets_[dataset], frames);
}

}  // namespace actformer::ingest
