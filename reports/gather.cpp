#include "reports/gather.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "ingest/dataset.hpp"
#include "ingest/file.hpp"
#include "ingest/motions_file.hpp"
#include "ingest/ntu/skeleton_file.hpp"
#include "kernels/error.hpp"

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
    count = std::min(count, candidates.size());
    for (std::size_t left = count, round = 0; left > 0; ++round) {
        const std::size_t now = std::min(left, classes.size());
        for (std::size_t i = 0; i < now; ++i) {
            auto& share = shares[i * classes.size() / now];
            if (share < classes[i * classes.size() / now].size()) {
                ++share;
                --left;
            }
        }
        if (round > candidates.size()) break;
    }
    std::vector<std::size_t> picks;
    for (std::size_t c = 0; c < classes.size(); ++c)
        for (std::size_t i = 0; i < shares[c]; ++i)
            picks.push_back(classes[c][i * classes[c].size() / shares[c]]);
    return picks;
}

/// The class that --class asks for: its name, or its number counted from 0.
std::uint32_t class_called(const std::string& text, const std::vector<std::string>& classes,
                           const std::string& where) {
    if (const auto found = std::ranges::find(classes, text); found != classes.end())
        return static_cast<std::uint32_t>(found - classes.begin());
    const bool number =
        !text.empty() && text.size() < 7 && text.find_first_not_of("0123456789") == std::string::npos;
    if (number && (classes.empty() || std::stoul(text) < classes.size()))
        return static_cast<std::uint32_t>(std::stoul(text));
    throw Error("{} has no class '{}'; give a name or a number from 0{}", where, text,
                classes.empty() ? ""
                                : fmt::format(" to {} ('{}' .. '{}')", classes.size() - 1, classes.front(),
                                              classes.back()));
}

/// Those of `candidates` that --class lets pass; all without it.
std::vector<Candidate> of_class(std::vector<Candidate> candidates, const Wanted& wanted,
                                const std::vector<std::string>& classes, const std::string& where) {
    if (wanted.label.empty()) return candidates;
    const auto label = class_called(wanted.label, classes, where);
    std::erase_if(candidates, [&](const Candidate& c) { return c.label != label; });
    if (candidates.empty()) throw Error("{} has no motion of class '{}' to draw", where, wanted.label);
    return candidates;
}

std::string title_of(const std::string& name, const std::optional<std::uint32_t>& label,
                     const std::vector<std::string>& classes) {
    return label && *label < classes.size() ? fmt::format("{} · {}", classes[*label], name) : name;
}

std::vector<std::size_t> picks_of(const ingest::Dataset& dataset, const Wanted& wanted, std::size_t count) {
    const auto where = dataset.folder().string();
    std::vector<Candidate> candidates;
    for (const auto i : dataset.split(wanted.split)) candidates.push_back({i, dataset.clips()[i].label});
    if (candidates.empty())
        throw Error("{}: split '{}' is empty, so there is nothing to draw", where, wanted.split);
    return spread(of_class(std::move(candidates), wanted, dataset.header().classes, where), count);
}

Figure figure_of_clip(const ingest::Dataset& dataset, std::size_t clip) {
    const auto& header = dataset.header();
    const auto& entry = dataset.clips()[clip];
    return figure_of(dataset.motion(clip), header.topology, dataset.bone_length(clip), header.fps,
                     title_of(entry.name, entry.label, header.classes));
}

std::vector<Figure> figures_by_name(const std::vector<ingest::Dataset>& datasets, const fs::path& path,
                                    const std::vector<std::string>& names) {
    std::vector<Figure> figures;
    for (const auto& name : names) {
        const auto before = figures.size();
        for (const auto& dataset : datasets)
            if (const auto clip = dataset.find(name)) figures.push_back(figure_of_clip(dataset, *clip));
        if (figures.size() == before)
            throw Error("{} has no clip '{}'; its clips are called as in '{}'", path.string(), name,
                        datasets[0].clips().empty() ? "" : datasets[0].clips()[0].name);
    }
    return figures;
}

std::vector<Figure> figures_of_datasets(const fs::path& path, const Wanted& wanted) {
    const auto folders = ingest::datasets_at(path);
    std::vector<ingest::Dataset> datasets(folders.begin(), folders.end());
    if (!wanted.clips.empty()) return figures_by_name(datasets, path, wanted.clips);

    // A class by name may be in one of the datasets of a folder only, as handshaking is in ntu-2p.
    const auto named = [&](const ingest::Dataset& d) {
        return std::ranges::count(d.header().classes, wanted.label) > 0;
    };
    if (std::ranges::any_of(datasets, named)) std::erase_if(datasets, std::not_fn(named));

    std::vector<Figure> figures;
    for (std::size_t d = 0; d < datasets.size(); ++d) {
        const auto count = wanted.count * (d + 1) / datasets.size() - wanted.count * d / datasets.size();
        if (count == 0) continue;
        for (const auto clip : picks_of(datasets[d], wanted, count))
            figures.push_back(figure_of_clip(datasets[d], clip));
    }
    return figures;
}

/// What a motions file does not say, and --bones may: the skeleton, its lengths, the classes.
struct Body {
    std::optional<ingest::Dataset> dataset;
    ingest::Topology topology;
    std::vector<float> lengths;  ///< (K) metres

    std::vector<std::string> classes() const {
        return dataset ? dataset->header().classes : std::vector<std::string>{};
    }
};

/// Mean limb lengths over up to 200 clips, evenly chosen, and all their persons.
std::vector<float> mean_bone_lengths(const ingest::Dataset& dataset) {
    const auto k = dataset.header().topology.joints();
    const auto clips = dataset.clips().size(), looks = std::min<std::size_t>(clips, 200);
    std::vector<double> sums(k, 0);
    std::size_t bodies = 0;
    for (std::size_t i = 0; i < looks; ++i) {
        const auto lengths = dataset.bone_length(i * clips / looks);
        for (std::size_t at = 0; at < lengths.size(); ++at) sums[at % k] += lengths[at];
        bodies += lengths.size() / k;
    }
    if (bodies == 0) throw Error("{} has no clips to take limb lengths from", dataset.folder().string());
    std::vector<float> mean(k);
    for (std::size_t j = 0; j < k; ++j) mean[j] = static_cast<float>(sums[j] / static_cast<double>(bodies));
    return mean;
}

Body body_for(std::uint32_t joints, const fs::path& path, const Wanted& wanted) {
    Body body;
    if (!wanted.bones.empty()) {
        body.dataset.emplace(wanted.bones);
        body.topology = body.dataset->header().topology;
        if (body.topology.joints() != joints)
            throw Error("{} has motions of {} joints, and {} of {}; give the --bones it was trained on",
                        path.string(), joints, wanted.bones.string(), body.topology.joints());
        body.lengths = mean_bone_lengths(*body.dataset);
    } else if (joints == ingest::ntu25().joints()) {
        body.topology = ingest::ntu25();
        body.lengths = usual_bone_lengths(body.topology);
    } else {
        throw Error(
            "{} does not say how its {} joints hang together; give --bones DATASET with the same skeleton",
            path.string(), joints);
    }
    return body;
}

/// The class of a motion in the public layout: the clip's own in --bones, else what follows A in its name,
/// counted from 1.
std::optional<std::uint32_t> label_of(const std::string& name, const Body& body) {
    if (body.dataset)
        if (const auto clip = body.dataset->find(name)) return body.dataset->clips()[*clip].label;
    const auto at = name.rfind('A');
    if (at == std::string::npos) return {};
    const auto digits = name.substr(at + 1, name.find_first_not_of("0123456789", at + 1) - at - 1);
    if (digits.empty() || digits.size() > 6 || std::stoul(digits) == 0) return {};
    return static_cast<std::uint32_t>(std::stoul(digits) - 1);
}

std::vector<Figure> figures_of_motions(const fs::path& path, const Wanted& wanted) {
    if (wanted.split != "all")
        throw Error("{} is a motions file and has no splits; leave --split out", path.string());
    const ingest::MotionsFile file(path);
    const auto& names = file.names();
    if (names.empty()) throw Error("{} has no motions in it", path.string());
    const auto body = body_for(file.read(names[0]).joints, path, wanted);

    std::vector<std::size_t> picks;
    for (const auto& name : wanted.clips) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end())
            throw Error("{} has no motion '{}'; its motions are called as in '{}'", path.string(), name,
                        names[0]);
        picks.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (wanted.clips.empty()) {
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < names.size(); ++i) candidates.push_back({i, label_of(names[i], body)});
        picks = spread(of_class(std::move(candidates), wanted, body.classes(), path.string()), wanted.count);
    }
    const double fps = body.dataset ? body.dataset->header().fps : 30;
    std::vector<Figure> figures;
    for (const auto i : picks) {
        const auto motion = file.read(names[i]);
        std::vector<float> lengths;
        for (std::uint32_t p = 0; p < motion.persons; ++p)
            lengths.insert(lengths.end(), body.lengths.begin(), body.lengths.end());
        figures.push_back(figure_of(motion, body.topology, lengths, fps,
                                    title_of(names[i], label_of(names[i], body), body.classes())));
    }
    return figures;
}

/// A raw capture is drawn as it was recorded: bodies appear and vanish, and nothing is smoothed.
Figure figure_of_raw(const fs::path& path) {
    std::vector<char> text;
    const auto read = ingest::read_skeleton(ingest::read_text(path, text, std::uint64_t{1} << 27));
    if (const auto* why = std::get_if<ingest::Rejection>(&read))
        throw Error("{}: {}", path.string(), why->reason);
    return figure_of(std::get<ingest::SkeletonFile>(read), path.stem().string() + ", raw");
}

}  // namespace

std::vector<Figure> gather(const fs::path& path, const Wanted& wanted) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) throw Error("{}: no such file or folder", path.string());
    if (fs::is_directory(path, ignored)) return figures_of_datasets(path, wanted);
    if (path.extension() == ".skeleton") return {figure_of_raw(path)};
    return figures_of_motions(path, wanted);
}

}  // namespace actformer::reports
