#include "ingest/formats/uestc/uestc_format.hpp"

#include <algorithm>
#include <charconv>

#include "base/error.hpp"
#include "base/pickle/pickle.hpp"
#include "base/text/counted.hpp"
#include "base/text/printable.hpp"
#include "base/text/trimmed_lines.hpp"
#include "ingest/formats/parsed.hpp"
#include "ingest/formats/rotational/pose_rows.hpp"
#include "ingest/formats/uestc/video.hpp"
#include "ingest/formats/vibe/vibe.hpp"

namespace actformer::ingest {
namespace {

constexpr std::string_view pickle_name = "vibe_cache_refined";
constexpr std::size_t published = 25600;  // videos

std::vector<std::uint64_t> numbers_of(const std::vector<std::string>& lines) {
    std::vector<std::uint64_t> numbers;
    for (const auto& line : lines) {
        std::uint64_t number = 0;
        const auto [end, fault] = std::from_chars(line.data(), line.data() + line.size(), number);
        if (fault != std::errc() || end != line.data() + line.size())
            throw Error("num_frames_min.txt: {} is no number of frames", in_quotes(line));
        numbers.push_back(number);
    }
    return numbers;
}

std::vector<Split> splits() {
    Condition trained{"subject", {}};
    for (int subject = 1; subject <= uestc::subjects; ++subject)
        if (uestc::trains(subject)) trained.values.push_back(std::to_string(subject));
    auto tested = trained;
    tested.negated = true;
    return {{"train", {trained}}, {"test", {tested}}};
}

std::string stem_of(const std::string& video) {
    constexpr std::string_view end = "_color.avi";
    return video.ends_with(end) ? video.substr(0, video.size() - end.size()) : video;
}

}  // namespace

/// The pickle's lists, an element a video.
class UestcFormat::Videos {
  public:
    Videos(const PickleValue& file, std::size_t named)
        : poses_(file.get("pose")), joints_(file.get("joints3d")), cameras_(file.get("orig_cam")) {
        if (poses_.size() != joints_.size() || poses_.size() != cameras_.size())
            throw Error("'pose' has {} videos, 'joints3d' {} and 'orig_cam' {}: their lengths differ",
                        poses_.size(), joints_.size(), cameras_.size());
        if (poses_.size() != named)
            throw Error("{} videos, and names.txt has {} names; get both from one archive", poses_.size(),
                        named);
    }

    std::size_t size() const { return poses_.size(); }

    /// Of the first frames, facing the camera in front, y down.
    RotationalMotion motion(std::size_t video, std::uint64_t most_frames, const Quaternion& to_front) const {
        const auto poses = smpl_poses(poses_[video].array(), "pose");
        const auto joints = vibe::joint_rows(joints_[video].array(), "joints3d");
        const NumpyRows cameras(cameras_[video].array(), "orig_cam", {4});
        const auto frames = std::min(most_frames, poses.count());
        if (joints.count() < frames || cameras.count() < frames)
            throw Error("{} frames of 'pose', {} of 'joints3d' and {} of 'orig_cam'", poses.count(),
                        joints.count(), cameras.count());
        const auto way = uestc::trajectory(cameras, joints, frames);
        std::vector<double> row(joints.size());
        auto motion = motion_of(poses.first(frames), [&](std::uint64_t frame, double* xyz) {
            joints.read(frame, row.data());
            for (std::size_t d = 0; d < 3; ++d) xyz[d] = row[3 * vibe::mid_hip + d] + way[3 * frame + d];
        });
        turn(motion, to_front);
        return motion;
    }

    std::size_t bytes(std::size_t video) const {
        std::size_t bytes = 0;
        for (const auto* list : {&poses_, &joints_, &cameras_})
            if ((*list)[video].is_array()) bytes += (*list)[video].array().values.size();
        return bytes;
    }

  private:
    PickleValue poses_, joints_, cameras_;
};

void UestcFormat::survey(const RawText& raw) {
    if (!raw.ends_in(".txt")) return;
    List list{printable(raw.path), {}};
    for (const auto line : trimmed_lines(raw.text)) list.lines.push_back(printable(line));
    const std::lock_guard lock(surveying_);
    lists_[std::string(raw.stem)].emplace(raw.index, std::move(list));
}

const std::vector<std::string>& UestcFormat::list(const std::string& name) const {
    const auto found = lists_.find(name);
    if (found == lists_.end())
        throw Error(
            "{}.txt is not there, which tells {}; it is in the folder info beside the pickle: give the whole "
            "folder or archive",
            name,
            name == "names"            ? "which video is which"
            : name == "num_frames_min" ? "how long videos are"
                                       : "the actions");
    const auto& first = found->second.begin()->second;
    for (const auto& [index, other] : found->second)
        if (other.lines != first.lines)
            throw Error("{}: other lines than in {}; give the folder or archive of one of them alone",
                        other.path, first.path);
    return first.lines;
}

void UestcFormat::settle() {
    names_ = list("names");
    frames_ = numbers_of(list("num_frames_min"));
    if (frames_.size() != names_.size())
        throw Error("names.txt has {} videos, and num_frames_min.txt {}: get both from one archive",
                    names_.size(), frames_.size());
    auto header = target_.header(name_);
    header.classes = list("action_classes");
    header.fields = {"action", "view", "subject", "side"};
    header.splits = splits();
    datasets_ = {std::move(header)};
    if (names_.size() != published)
        remarks_.push_back(fmt::format("{}; UESTC has {}", counted(names_.size(), "video"), published));
}

void UestcFormat::read(const RawText& raw, ClipSink& sink) const {
    if (raw.ends_in(".txt")) return;
    if (raw.stem == "globtrans_usez") return;  // trajectories that another program has computed
    if (raw.stem != pickle_name)
        return sink.take(Rejection{Rejection::Kind::dropped, fmt::format("not {}.pkl", pickle_name)});
    try {
        const Pickle file(raw.text, {}, [&](const char* here) { raw.release(here); });
        const Videos videos(file.root(), names_.size());
        make_in_order(
            videos.size(), sink, [&](std::size_t i) { return videos.bytes(i); },
            [&](std::size_t i) {
                return made_or_broken(printable(names_[i]), [&] { return parse(videos, i); });
            },
            [&](std::size_t bytes) { raw.release_read(bytes); });
    } catch (const Error& e) {
        sink.take(Rejection{Rejection::Kind::broken, e.what()});
    }
}

ParsedClip UestcFormat::parse(const Videos& videos, std::size_t video) const {
    const auto name = uestc::parse_video_name(names_[video]);
    if (!name) throw Error("the name is not aACTION_dVIEW_pSUBJECT_cSIDE_color.avi");
    const auto& classes = datasets_[0].classes;
    if (name->action >= classes.size())
        throw Error("action {}, and action_classes.txt has {}, from 0", name->action, classes.size());
    const auto to_front = name->to_front();
    if (!to_front)
        return Rejection{Rejection::Kind::dropped,
                         fmt::format("{}: moving camera, pose unknown", printable(names_[video]))};
    auto motion = videos.motion(video, frames_[video], *to_front);
    if (!published_) turn(motion, y_down_to_y_up);
    auto clip = whole(motion, target_);
    clip->name = stem_of(names_[video]);
    clip->label = name->action;
    clip->fields = {std::to_string(name->action + 1), std::to_string(name->view),
                    std::to_string(name->subject), std::to_string(name->side)};
    return clip;
}

}  // namespace actformer::ingest
