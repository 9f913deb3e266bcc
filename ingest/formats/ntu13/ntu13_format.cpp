#include "ingest/formats/ntu13/ntu13_format.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "base/pickle/pickle.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"
#include "base/text/trimmed_lines.hpp"
#include "ingest/formats/motions/position_clips.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/formats/ntu/name.hpp"
#include "ingest/formats/parsed.hpp"
#include "ingest/formats/rotational/pose_rows.hpp"
#include "ingest/formats/vibe/vibe.hpp"

namespace actformer::ingest {
namespace {

constexpr std::string_view list_name = "ntu_vibe_list";

/// NTU's numbers of the classes, in their order.
constexpr std::array actions{6, 7, 8, 9, 22, 23, 24, 38, 80, 93, 99, 100, 102};

constexpr std::int64_t person = 1;  // the others of a file are passers-by or lost tracks

std::optional<std::uint32_t> label_of(int action) {
    const auto found = std::find(actions.begin(), actions.end(), action);
    if (found == actions.end()) return {};
    return static_cast<std::uint32_t>(found - actions.begin());
}

/// "S001C001P001R001A099" of a path that ends in it and .pkl.
std::string_view stem_of(std::string_view path) {
    path = path.substr(path.find_last_of("/\\") + 1);
    return path.substr(0, path.rfind('.'));
}

/// The file's dictionary of the person; none where there is no such person.
std::optional<PickleValue> person_of(const PickleValue& file) {
    if (!file.is_dict()) throw Error("{}, where a dict of persons is meant", file.what());
    return file.find(person);
}

std::string other_persons(const PickleValue& file) {
    std::vector<std::string> there;
    for (std::size_t i = 0; i < file.size(); ++i) there.push_back(file.entry(i).first.what());
    return there.empty() ? "nobody" : first_few(there);
}

/// In the camera's frame, the root where VIBE saw it.
RotationalMotion motion_of(const PickleValue& tracked) {
    const auto poses = smpl_poses(tracked.get("pose").array(), "pose");
    const auto joints = vibe::joint_rows(tracked.get("joints3d").array(), "joints3d");
    if (joints.count() != poses.count())
        throw Error("{} frames of 'pose' and {} of 'joints3d'", poses.count(), joints.count());
    std::vector<double> row(joints.size());
    return ingest::motion_of(poses, [&](std::uint64_t frame, double* xyz) {
        joints.read(frame, row.data());
        std::copy_n(&row[3 * vibe::mid_hip], 3, xyz);
    });
}

std::variant<std::unique_ptr<PositionClip>, Rejection> joints_of(const PickleValue& tracked, Up up,
                                                                 const DatasetHeader& header) {
    const auto rows = vibe::joint_rows(tracked.get("joints3d").array(), "joints3d");
    const auto values = vibe::action2motion18_of(rows);
    NumpyArray chosen;
    chosen.take_type("<f8");
    chosen.shape = {rows.count(), header.topology.joints(), 3};
    chosen.values = {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
    return position_clip(chosen, up, header);
}

DatasetHeader header_of(const Ntu13Options& options) {
    if (!options.joints) return options.target.header(options.dataset);
    DatasetHeader header;
    header.name = options.dataset;
    header.topology = vibe::action2motion18();
    header.representation = options.target.of_joints();
    header.origin.kind = DataOrigin::Kind::recorded;
    return header;
}

}  // namespace

Ntu13Format::Ntu13Format(Ntu13Options options)
    : options_(std::move(options)), datasets_{header_of(options_)} {
    auto& header = datasets_[0];
    header.fields = ntu_fields();
    for (const int action : actions) header.classes.emplace_back(ntu::action_name(action));
}

std::string Ntu13Format::settings() const {
    const auto what = options_.joints
                          ? fmt::format("{} of Action2Motion's joints", datasets_[0].representation.name())
                          : options_.target.text();
    return fmt::format("ntu13{}: {}", options_.published ? ", y down" : "", what);
}

bool Ntu13Format::is_list(const RawText& raw) {
    return raw.stem == list_name && raw.ends_in(".txt");
}

void Ntu13Format::survey(const RawText& raw) {
    const std::lock_guard lock(surveying_);
    if (!is_list(raw)) {
        if (raw.ends_in(".pkl")) seen_.emplace_back(raw.stem);
        return;
    }
    for (const auto line : trimmed_lines(raw.text)) listed_.emplace(stem_of(line), line);
}

void Ntu13Format::settle() {
    std::sort(seen_.begin(), seen_.end());
    for (const auto& [name, line] : listed_)
        if (!std::binary_search(seen_.begin(), seen_.end(), name)) absent_.push_back(line);
    if (listed_.empty())
        remarks_.push_back(
            fmt::format("no {}.txt, which names the data set's files: all are taken", list_name));
    if (!absent_.empty())
        remarks_.push_back(fmt::format("{} of the {} files that {}.txt names are not there", absent_.size(),
                                       listed_.size(), list_name));
}

void Ntu13Format::read(const RawText& raw, ClipSink& sink) const {
    if (raw.ends_in(".pkl")) return sink.take(made_or_broken("", [&] { return parse(raw); }));
    if (!is_list(raw)) return;
    for (const auto& line : absent_)
        sink.take(Rejection{Rejection::Kind::missing,
                            fmt::format("{}: named in the list, and not there", in_quotes(line))});
}

ParsedClip Ntu13Format::parse(const RawText& raw) const {
    if (!listed_.empty() && !listed_.contains(std::string(raw.stem)))
        return Rejection{Rejection::Kind::dropped, fmt::format("not in {}.txt", list_name)};
    const auto name = parse_ntu_name(raw.stem);
    if (!name) throw Error("the name is not SsssCcccPpppRrrrAaaa with an action from 001 to 120");
    const auto label = label_of(name->action);
    if (!label)
        return Rejection{Rejection::Kind::dropped, fmt::format("action {} is none of the 13", name->action)};
    const Pickle file(raw.text);
    const auto tracked = person_of(file.root());
    if (!tracked)
        return Rejection{Rejection::Kind::dropped, fmt::format("person {} was not tracked, only {}", person,
                                                               other_persons(file.root()))};
    std::unique_ptr<RawClip> clip;
    if (options_.joints) {
        auto made = joints_of(*tracked, options_.published ? Up::y : Up::minus_y, datasets_[0]);
        if (auto* rejection = std::get_if<Rejection>(&made)) return std::move(*rejection);
        clip = std::move(std::get<0>(made));
    } else {
        auto motion = motion_of(*tracked);
        if (!options_.published) turn(motion, y_down_to_y_up);
        clip = whole(motion, options_.target);
    }
    clip->name = raw.stem;
    clip->label = *label;
    clip->fields = ntu_fields_of(*name);
    return clip;
}

kernels::CleanedBatch Ntu13Format::clean(kernels::Device& device, std::size_t dataset,
                                         std::span<const std::unique_ptr<RawClip>> clips,
                                         std::vector<std::uint32_t>& frames) const {
    return options_.joints ? cleaned(device, clips, datasets_[dataset], frames)
                           : gathered(clips, options_.target, frames);
}

}  // namespace actformer::ingest
