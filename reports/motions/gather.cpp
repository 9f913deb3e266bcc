#include "reports/motions/gather.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/nearest_file.hpp"
#include "base/text/suggestion.hpp"
#include "ingest/dataset/classes.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

/// A motion that may be drawn: its place in its file, and its class where that is known.
struct Candidate {
    std::size_t index = 0;
    std::optional<std::uint32_t> label;
};

/// Spreads `count` picks evenly over the classes, and within a class over its clips. In the order of the
/// classes.
std::vector<std::size_t> spread(const std::vector<Candidate>& candidates, std::size_t count) {
    std::map<std::int64_t, std::vector<std::size_t>> by_class;
    for (const auto& c : candidates) by_class[c.label ? std::int64_t{*c.label} : -1].push_back(c.index);
    std::vector<std::vector<std::size_t>> classes;
    for (auto& [label, indices] : by_class) classes.push_back(std::move(indices));

    std::vector<std::size_t> shares(classes.size(), 0);
    for (auto left = std::min(count, candidates.size()); left > 0;) {
        std::vector<std::size_t> open;  // classes with motions left
        for (std::size_t c = 0; c < classes.size(); ++c)
            if (shares[c] < classes[c].size()) open.push_back(c);
        const auto now = std::min(left, open.size());
        for (std::size_t i = 0; i < now; ++i) ++shares[open[i * open.size() / now]];
        left -= now;
    }
    std::vector<std::size_t> picks;
    for (std::size_t c = 0; c < classes.size(); ++c)
        for (std::size_t i = 0; i < shares[c]; ++i)
            picks.push_back(classes[c][i * classes[c].size() / shares[c]]);
    return picks;
}

/// As many of each class as `wanted` says, or else `count` of all of them.
std::vector<std::size_t> chosen(const std::vector<Candidate>& candidates, const Wanted& wanted,
                                std::size_t count) {
    if (wanted.per_class == 0) return spread(candidates, count);
    std::map<std::int64_t, std::size_t> taken;
    std::vector<Candidate> some;
    for (const auto& c : candidates)
        if (taken[c.label ? std::int64_t{*c.label} : -1]++ < wanted.per_class) some.push_back(c);
    return spread(some, some.size());
}

/// Those of `candidates` that --class lets pass; all without it.
std::vector<Candidate> of_class(std::vector<Candidate> candidates, const Wanted& wanted,
                                const std::vector<std::string>& classes, const std::string& where) {
    if (wanted.label.empty()) return candidates;
    const auto label = ingest::label_called(wanted.label, classes, where);
    std::erase_if(candidates, [&](const Candidate& c) { return c.label != label; });
    if (candidates.empty()) throw Error("{} has no motion of class '{}' to draw", where, wanted.label);
    return candidates;
}

std::string title_of(const std::string& name, const std::optional<std::uint32_t>& label,
                     const std::vector<std::string>& classes) {
    return label && *label < classes.size() ? fmt::format("{} · {}", classes[*label], name) : name;
}

std::vector<std::size_t> picks_of(const ingest::Dataset& dataset, const Wanted& wanted, std::size_t count,
                                  std::size_t& there) {
    const auto where = dataset.folder().string();
    std::vector<Candidate> candidates;
    for (const auto i : dataset.split(wanted.split)) candidates.push_back({i, dataset.clips()[i].label});
    if (candidates.empty())
        throw Error("{}: split '{}' is empty, so there is nothing to draw", where, wanted.split);
    candidates = of_class(std::move(candidates), wanted, dataset.header().classes, where);
    there += candidates.size();
    return chosen(candidates, wanted, count);
}

/// With the body on it where one is wanted.
JointMotion motion_of(const ingest::Motion& motion, const ingest::BodyModel& body, double fps,
                      const std::string& title, const Wanted& wanted) {
    return wanted.body ? joint_motion(motion, body, fps, title, wanted.body)
                       : joint_motion(motion, body, fps, title);
}

JointMotion motion_of_clip(const ingest::Dataset& dataset, std::size_t clip, const Wanted& wanted) {
    const auto& header = dataset.header();
    const auto& entry = dataset.clips()[clip];
    auto motion = motion_of(dataset.motion(clip), dataset.body(clip), header.fps,
                            title_of(entry.name, entry.label, header.classes), wanted);
    motion.label = entry.label;
    return motion;
}

std::vector<JointMotion> motions_by_name(const std::vector<ingest::Dataset>& datasets, const fs::path& path,
                                         const Wanted& wanted) {
    std::vector<JointMotion> motions;
    for (const auto& name : wanted.clips) {
        const auto before = motions.size();
        for (const auto& dataset : datasets)
            if (const auto clip = dataset.find(name))
                motions.push_back(motion_of_clip(dataset, *clip, wanted));
        if (motions.size() > before) continue;
        std::vector<std::string> names;
        for (const auto& dataset : datasets)
            for (const auto& clip : dataset.clips()) names.push_back(clip.name);
        throw Error("{} has no clip '{}'; its clips are called as in '{}'{}", path.string(), name,
                    names.empty() ? "" : names[0], suggestion(name, names));
    }
    return motions;
}

/// Throws Error with the class of any of the datasets that was probably meant.
void refuse_class(const std::vector<ingest::Dataset>& datasets, const fs::path& path,
                  const std::string& said) {
    std::vector<std::string> classes;
    for (const auto& dataset : datasets)
        classes.insert(classes.end(), dataset.header().classes.begin(), dataset.header().classes.end());
    ingest::label_called(said, classes, path.string());
}

std::vector<JointMotion> motions_of_datasets(const fs::path& path, const Wanted& wanted, std::size_t& there) {
    const auto folders = ingest::datasets_at(path);
    std::vector<ingest::Dataset> datasets(folders.begin(), folders.end());
    if (!wanted.clips.empty()) return motions_by_name(datasets, path, wanted);

    // A class by name may be in one of the datasets of a folder only, as shaking hands is in ntu-2p.
    const auto named = [&](const ingest::Dataset& d) {
        try {
            ingest::label_called(wanted.label, d.header().classes, "");
            return true;
        } catch (const Error&) {
            return false;
        }
    };
    if (std::ranges::any_of(datasets, named))
        std::erase_if(datasets, std::not_fn(named));
    else if (!wanted.label.empty())
        refuse_class(datasets, path, wanted.label);

    std::vector<JointMotion> motions;
    for (std::size_t d = 0; d < datasets.size(); ++d) {
        const auto count = wanted.count * (d + 1) / datasets.size() - wanted.count * d / datasets.size();
        if (count == 0) continue;
        for (const auto clip : picks_of(datasets[d], wanted, count, there))
            motions.push_back(motion_of_clip(datasets[d], clip, wanted));
    }
    return motions;
}

/// The class of a motion: as the file or --bones tell it, else what follows A in any name, counted from 1.
std::optional<std::uint32_t> label_of(const std::string& name, const ingest::DescribedMotions& file) {
    if (const auto label = file.label(name)) return label;
    const auto at = name.rfind('A');
    if (at == std::string::npos) return {};
    const auto digits = name.substr(at + 1, name.find_first_not_of("0123456789", at + 1) - at - 1);
    if (digits.empty() || digits.size() > 6 || std::stoul(digits) == 0) return {};
    return static_cast<std::uint32_t>(std::stoul(digits) - 1);
}

std::vector<JointMotion> motions_of_motions(const fs::path& path, const Wanted& wanted, std::size_t& there) {
    if (wanted.split != "all")
        throw Error("{} is a motions file and has no splits; leave --split out", path.string());
    const ingest::DescribedMotions file(path, wanted.bones);
    const auto& names = file.motions().names();
    const auto& subjects = file.subjects();

    std::vector<std::size_t> picks;
    for (const auto& name : wanted.clips) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end())
            throw Error("{} has no motion '{}'; its motions are called as in '{}'{}", path.string(), name,
                        names[0], suggestion(name, names));
        picks.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (wanted.clips.empty()) {
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < names.size(); ++i) candidates.push_back({i, label_of(names[i], file)});
        candidates = of_class(std::move(candidates), wanted, subjects.classes, path.string());
        there += candidates.size();
        picks = chosen(candidates, wanted, wanted.count);
    }
    std::vector<JointMotion> motions;
    for (const auto i : picks) {
        const auto motion = file.motions().read(names[i]);
        const auto label = label_of(names[i], file);
        motions.push_back(
            motion_of(motion, subjects, subjects.fps, title_of(names[i], label, subjects.classes), wanted));
        motions.back().label = label;
    }
    return motions;
}

/// A raw capture is drawn as it was recorded: bodies appear and vanish, and nothing is smoothed.
JointMotion motion_of_raw(const fs::path& path) {
    std::vector<char> text;
    const auto read = ingest::read_skeleton(read_text(path, text, std::uint64_t{1} << 27));
    if (const auto* why = std::get_if<ingest::Rejection>(&read))
        throw Error("{}: {}", path.string(), why->reason);
    return joint_motion(std::get<ingest::SkeletonFile>(read), path.stem().string() + ", raw");
}

}  // namespace

std::vector<JointMotion> gather(const fs::path& path, const Wanted& wanted, std::size_t* there) {
    std::error_code ignored;
    std::size_t picked_from = 0;
    const auto told = [&](std::vector<JointMotion> motions) {
        if (there) *there = std::max(picked_from, motions.size());
        return motions;
    };
    if (!fs::exists(path, ignored))
        throw Error("{}: no such file or folder{}", path.string(), did_you_mean(path));
    if (fs::is_directory(path, ignored)) return told(motions_of_datasets(path, wanted, picked_from));
    if (path.extension() == ".skeleton") {
        if (wanted.body)
            throw Error("{}: a raw capture has no rotations to put a body on; leave --body out",
                        path.string());
        return told({motion_of_raw(path)});
    }
    return told(motions_of_motions(path, wanted, picked_from));
}

}  // namespace actformer::reports
