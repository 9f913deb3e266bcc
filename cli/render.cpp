// actformer render: motions as a contact sheet, a GIF or an MP4.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "ingest/dataset.hpp"
#include "ingest/motions_file.hpp"
#include "kernels/error.hpp"
#include "reports/figure.hpp"
#include "reports/render.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;
using reports::Figure;

struct Options {
    std::vector<fs::path> inputs;
    fs::path output, bones;
    std::vector<std::string> clips;
    std::string split = "all", label, view = "three-quarter";
    std::size_t count = 6;
    int size = 0, columns = 8;
    double fps = 0;
};

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
std::vector<Candidate> of_class(std::vector<Candidate> candidates, const Options& options,
                                const std::vector<std::string>& classes, const std::string& where) {
    if (options.label.empty()) return candidates;
    const auto wanted = class_called(options.label, classes, where);
    std::erase_if(candidates, [&](const Candidate& c) { return c.label != wanted; });
    if (candidates.empty()) throw Error("{} has no motion of class '{}' to draw", where, options.label);
    return candidates;
}

std::string title_of(const std::string& name, const std::optional<std::uint32_t>& label,
                     const std::vector<std::string>& classes) {
    return label && *label < classes.size() ? fmt::format("{} · {}", classes[*label], name) : name;
}

std::vector<std::size_t> picks_of(const ingest::Dataset& dataset, const Options& options, std::size_t count) {
    const auto where = dataset.folder().string();
    std::vector<Candidate> candidates;
    for (const auto i : dataset.split(options.split)) candidates.push_back({i, dataset.clips()[i].label});
    if (candidates.empty())
        throw Error("{}: split '{}' is empty, so there is nothing to draw", where, options.split);
    return spread(of_class(std::move(candidates), options, dataset.header().classes, where), count);
}

Figure figure_of(const ingest::Dataset& dataset, std::size_t clip) {
    const auto& header = dataset.header();
    const auto& entry = dataset.clips()[clip];
    return reports::figure_of(dataset.motion(clip), header.topology, dataset.bone_length(clip), header.fps,
                              title_of(entry.name, entry.label, header.classes));
}

std::vector<Figure> figures_by_name(const std::vector<ingest::Dataset>& datasets, const fs::path& path,
                                    const std::vector<std::string>& names) {
    std::vector<Figure> figures;
    for (const auto& name : names) {
        const auto before = figures.size();
        for (const auto& dataset : datasets)
            if (const auto clip = dataset.find(name)) figures.push_back(figure_of(dataset, *clip));
        if (figures.size() == before)
            throw Error("{} has no clip '{}'; its clips are called as in '{}'", path.string(), name,
                        datasets[0].clips().empty() ? "" : datasets[0].clips()[0].name);
    }
    return figures;
}

std::vector<Figure> figures_of_datasets(const fs::path& path, const Options& options) {
    const auto folders = ingest::datasets_at(path);
    std::vector<ingest::Dataset> datasets(folders.begin(), folders.end());
    if (!options.clips.empty()) return figures_by_name(datasets, path, options.clips);

    // A class by name may be in one of the datasets of a folder only, as handshaking is in ntu-2p.
    const auto named = [&](const ingest::Dataset& d) {
        return std::ranges::count(d.header().classes, options.label) > 0;
    };
    if (std::ranges::any_of(datasets, named)) std::erase_if(datasets, std::not_fn(named));

    std::vector<Figure> figures;
    for (std::size_t d = 0; d < datasets.size(); ++d) {
        const auto count = options.count * (d + 1) / datasets.size() - options.count * d / datasets.size();
        if (count == 0) continue;
        for (const auto clip : picks_of(datasets[d], options, count))
            figures.push_back(figure_of(datasets[d], clip));
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

Body body_for(std::uint32_t joints, const fs::path& path, const Options& options) {
    Body body;
    if (!options.bones.empty()) {
        body.dataset.emplace(options.bones);
        body.topology = body.dataset->header().topology;
        if (body.topology.joints() != joints)
            throw Error("{} has motions of {} joints, and {} of {}; give the --bones it was trained on",
                        path.string(), joints, options.bones.string(), body.topology.joints());
        body.lengths = mean_bone_lengths(*body.dataset);
    } else if (joints == ingest::ntu25().joints()) {
        body.topology = ingest::ntu25();
        body.lengths = reports::usual_bone_lengths(body.topology);
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

std::vector<Figure> figures_of_motions(const fs::path& path, const Options& options) {
    if (options.split != "all")
        throw Error("{} is a motions file and has no splits; leave --split out", path.string());
    const ingest::MotionsFile file(path);
    const auto& names = file.names();
    if (names.empty()) throw Error("{} has no motions in it", path.string());
    const auto body = body_for(file.read(names[0]).joints, path, options);

    std::vector<std::size_t> picks;
    for (const auto& name : options.clips) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end())
            throw Error("{} has no motion '{}'; its motions are called as in '{}'", path.string(), name,
                        names[0]);
        picks.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (options.clips.empty()) {
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < names.size(); ++i) candidates.push_back({i, label_of(names[i], body)});
        picks =
            spread(of_class(std::move(candidates), options, body.classes(), path.string()), options.count);
    }
    const double fps = body.dataset ? body.dataset->header().fps : 30;
    std::vector<Figure> figures;
    for (const auto i : picks) {
        const auto motion = file.read(names[i]);
        std::vector<float> lengths;
        for (std::uint32_t p = 0; p < motion.persons; ++p)
            lengths.insert(lengths.end(), body.lengths.begin(), body.lengths.end());
        figures.push_back(reports::figure_of(motion, body.topology, lengths, fps,
                                             title_of(names[i], label_of(names[i], body), body.classes())));
    }
    return figures;
}

/// Raw captures are drawn as they were recorded, bodies appearing and vanishing (Figure::seen).
std::vector<Figure> figures_of_raw(const fs::path& path, const Options&) {
    throw Error("{} is a raw capture; run actformer ingest on it and draw the dataset", path.string());
}

std::vector<Figure> figures_of(const fs::path& path, const Options& options) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) throw Error("there is no {}", path.string());
    if (fs::is_directory(path, ignored)) return figures_of_datasets(path, options);
    if (path.extension() == ".skeleton") return figures_of_raw(path, options);
    return figures_of_motions(path, options);
}

void render(const Options& options) {
    const auto kind = reports::picture_kind(options.output);
    {
        const reports::Aside probe(options.output);
    }  // what cannot be written is said before the work, not after
    reports::Layout layout;
    layout.view = reports::parse_view(options.view);
    layout.columns = options.columns;
    layout.fps = options.fps;

    std::vector<Figure> figures;
    for (const auto& path : options.inputs)
        for (auto& figure : figures_of(path, options)) figures.push_back(std::move(figure));
    layout.size = options.size > 0                                           ? options.size
                  : kind != reports::PictureKind::png && figures.size() == 1 ? 480
                                                                             : 320;

    Progress progress("render", "frames");
    std::size_t frames = 0;
    reports::render(figures, layout, options.output, [&](std::size_t done, std::size_t all) {
        frames = all;
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    });
    progress.clear();
    std::error_code ignored;
    const auto kilobytes = static_cast<double>(fs::file_size(options.output, ignored)) / 1000;
    fmt::print("{}: {} motion{}{}, {:.0f} kB\n", options.output.string(), figures.size(),
               figures.size() == 1 ? "" : "s", frames > 0 ? fmt::format(", {} frames", frames) : "",
               kilobytes);
}

}  // namespace

void add_render(CLI::App& app) {
    auto* command = app.add_subcommand("render", "Draw motions: a contact sheet (.png), a .gif or an .mp4");
    auto options = std::make_shared<Options>();
    command->add_option("INPUT", options->inputs, "Datasets, or motions files in the public layout (.h5)")
        ->required();
    command
        ->add_option("-o,--output", options->output,
                     "What to write: .png a contact sheet, .gif or .mp4 moving")
        ->required();
    command->add_option("--clip", options->clips, "Draw this clip; may be given again")
        ->allow_extra_args(false);
    command->add_option("--split", options->split, "Draw from this split of the dataset")
        ->capture_default_str();
    command->add_option("--class", options->label, "Draw from this class: its name, or its number from 0");
    command->add_option("--count", options->count, "Motions of each INPUT, spread over its classes")
        ->check(CLI::Range(1, 400))
        ->capture_default_str();
    command->add_option("--bones", options->bones,
                        "Dataset whose skeleton and mean limb lengths a motions file is drawn with");
    command
        ->add_option("--view", options->view,
                     "front, side, back, top, orbit, three-quarter, or AZIMUTH,ELEVATION in degrees")
        ->capture_default_str();
    command
        ->add_option("--size", options->size,
                     "Height of a figure in pixels (default 320; 480 for one that moves)")
        ->check(CLI::Range(40, 4000));
    command->add_option("--columns", options->columns, "Snapshots in a row of the contact sheet")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command
        ->add_option("--fps", options->fps,
                     "Frames a second of a .gif or .mp4 (default: the motion's; a .gif has at most 50)")
        ->check(CLI::Range(0.1, 1000.0));
    examples(command,
             "  actformer render data/ntu-1p -o sheet.png\n"
             "  actformer render data/ntu-2p --class handshaking --count 4 -o handshakes.gif\n"
             "  actformer render data/ntu-1p --clip S001C001P001R001A001 --view orbit -o drink.mp4\n"
             "  actformer render generated.h5 --bones data/ntu-1p --count 9 -o generated.mp4\n");
    command->callback([options] { render(*options); });
}

}  // namespace actformer::cli
