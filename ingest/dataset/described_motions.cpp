#include "ingest/dataset/described_motions.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/error.hpp"

namespace actformer::ingest {

namespace fs = std::filesystem;

DescribedMotions::DescribedMotions(const fs::path& path, const fs::path& bones)
    : path_(path),
      bones_(bones.empty() ? std::nullopt : std::optional<Dataset>(bones)),
      file_(path, bones_ ? bones_->header().representation : Representation()) {
    const auto first = file_.read(file_.names()[0]);
    file_.check_limbs();
    subjects_ = find_subjects();
    const auto nodes = subjects_.representation.nodes(subjects_.topology);
    if (nodes != first.nodes)
        throw Error("{} has motions of {} nodes, and {} says {}; give the --bones it was trained on",
                    path.string(), first.nodes, (bones.empty() ? path : bones).string(), nodes);
}

Subjects DescribedMotions::find_subjects() const {
    const auto how = file_.representation();
    if (bones_) {
        if (const auto other = bones_->header().representation; other != how)
            throw Error("{} has motions in {}, and {} is in {}; give the --bones it was trained on",
                        path_.string(), how.name(), bones_->folder().string(), other.name());
        return subjects_of(*bones_);
    }
    Subjects subjects;
    if (file_.subjects()) {
        subjects = *file_.subjects();
    } else {
        subjects.representation = how;
        subjects.topology = ntu25();
        const auto nodes = file_.read(file_.names()[0]).nodes;
        if (how == Representation::rot6d || nodes != subjects.topology.joints())
            throw Error(
                "{}: does not say how its {} nodes hang together; `export` and `render` take --bones DATASET "
                "with the same skeleton",
                path_.string(), nodes);
    }
    if (subjects.bone_length.empty()) subjects.bone_length = usual_bone_lengths(subjects.topology);
    return subjects;
}

BodyModel DescribedMotions::body(const std::string& name) const {
    BodyModel body = subjects_;
    if (auto own = file_.details(name).bone_length; !own.empty()) body.bone_length = std::move(own);
    return body;
}

std::optional<std::uint32_t> DescribedMotions::label(const std::string& name) const {
    if (const auto told = file_.details(name).label) return told;
    if (bones_)
        if (const auto clip = bones_->find(name)) return bones_->clips()[*clip].label;
    return label_in(name);
}

std::optional<std::uint32_t> label_in(const std::string& name) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const char* const end = name.data() + name.size();
    for (auto at = name.rfind('A'); at != std::string::npos;
         at = at == 0 ? name.npos : name.rfind('A', at - 1)) {
        const char *const digits = name.data() + at + 1, *const rest =
                                                             std::find_if_not(digits, end, is_digit);
        if (rest - digits < 3 || (rest != end && is_letter(*rest))) continue;
        std::uint32_t action = 0;
        if (std::from_chars(digits, rest, action).ec != std::errc() || action == 0) return {};
        return action - 1;
    }
    return {};
}

std::vector<float> usual_bone_lengths(const Topology& topology) {
    // Round figures for a standing adult of about 1.7 m as a depth camera sees one, in ntu25()'s order.
    static constexpr std::array<float, 25> adult{
        0,     0.29F, 0.08F, 0.14F, 0.17F, 0.26F, 0.23F, 0.07F, 0.17F, 0.26F, 0.23F, 0.07F, 0.08F,
        0.38F, 0.38F, 0.11F, 0.08F, 0.38F, 0.38F, 0.11F, 0.22F, 0.07F, 0.06F, 0.07F, 0.06F};
    if (topology.parents == ntu25().parents) return {adult.begin(), adult.end()};
    std::vector<float> lengths(topology.joints(), 0.2F);
    if (!lengths.empty()) lengths[0] = 0;
    return lengths;
}

}  // namespace actformer::ingest
