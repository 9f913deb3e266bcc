// actformer inspect: what is in a dataset, and whether it is whole.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/format.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "ingest/dataset/height.hpp"

namespace actformer::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Lengths {
    std::uint32_t shortest = 0, median = 0, longest = 0;
    std::uint64_t total = 0;
};

Lengths lengths_of(const ingest::Dataset& dataset) {
    std::vector<std::uint32_t> all;
    Lengths lengths;
    for (const auto& clip : dataset.clips()) {
        all.push_back(clip.frames);
        lengths.total += clip.frames;
    }
    if (all.empty()) return lengths;
    std::sort(all.begin(), all.end());
    lengths.shortest = all.front();
    lengths.median = all[all.size() / 2];
    lengths.longest = all.back();
    return lengths;
}

std::vector<std::size_t> clips_a_class(const ingest::Dataset& dataset) {
    std::vector<std::size_t> counts(dataset.header().classes.size(), 0);
    for (const auto& clip : dataset.clips()) ++counts[clip.label];
    return counts;
}

void print_text(const ingest::Dataset& dataset, bool list_classes) {
    const auto& header = dataset.header();
    const auto lengths = lengths_of(dataset);
    const auto counts = clips_a_class(dataset);
    std::uint64_t size = 0;
    for (const auto& shard : dataset.shards()) size += shard.bytes;
    say("{} ({})\n", dataset.folder().string(), header.name);
    say("  {} of {}, {} without a clip; {} joints in {}, {}, {:g} frames a second\n",
        counted(dataset.clips().size(), "clip"), counted(counts.size(), "class"),
        std::count(counts.begin(), counts.end(), 0U), header.topology.joints(), header.representation.name(),
        counted(header.persons, "person"), header.fps);
    say("  {} ({} to {} a clip, median {}) in {}, {}\n", counted(lengths.total, "frame"), lengths.shortest,
        lengths.longest, lengths.median, counted(dataset.shards().size(), "shard"), bytes(size));
    if (const auto origin = header.origin.text(); !origin.empty()) say("  {}\n", origin);
    if (const auto height = ingest::body_height(dataset))
        say("  about {:.2f} m from the lowest joint to the highest{}{}\n", height->metres,
            height->axis == 'y' ? "" : fmt::format(", along {}: bodies lie, or y is not up", height->axis),
            height->metres > ingest::tallest_body ? "; ingest in metres, with --scale" : "");
    for (const auto& remark : dataset.remarks()) say("  {}\n", remark);
    for (const auto& split : header.splits)
        say("  split {:<14} {}\n", split.name, counted(dataset.split(split.name).size(), "clip"));
    if (list_classes)
        for (std::size_t c = 0; c < counts.size(); ++c)
            say("  class {:>3}  {:<40} {}\n", c + 1, header.classes[c], counted(counts[c], "clip"));
}

Json to_json(const ingest::Dataset& dataset) {
    const auto& header = dataset.header();
    const auto lengths = lengths_of(dataset);
    const auto counts = clips_a_class(dataset);
    const auto height = ingest::body_height(dataset);
    Json splits = Json::object(), classes = Json::object();
    for (const auto& split : header.splits) splits[split.name] = dataset.split(split.name).size();
    for (std::size_t c = 0; c < counts.size(); ++c) classes[header.classes[c]] = counts[c];
    return {{"folder", dataset.folder().string()},
            {"name", header.name},
            {"source", dataset.fingerprint()},
            {"origin", header.origin.text()},
            {"clips", dataset.clips().size()},
            {"frames",
             {{"total", lengths.total},
              {"shortest", lengths.shortest},
              {"median", lengths.median},
              {"longest", lengths.longest}}},
            {"persons", header.persons},
            {"joints", header.topology.names},
            {"parents", header.topology.parents},
            {"representation", header.representation.name()},
            {"fps", header.fps},
            {"height",
             height ? Json{{"metres", height->metres}, {"axis", std::string(1, height->axis)}} : Json()},
            {"remarks", dataset.remarks()},
            {"shards", dataset.shards().size()},
            {"splits", splits},
            {"classes", classes}};
}

/// A motions file, as `generate` and `export` make them.
Json motions_json(const std::string& path) {
    const ingest::DescribedMotions file(path);
    const auto& subjects = file.subjects();
    std::set<std::uint32_t> labels, lengths;
    for (const auto& name : file.motions().names()) {
        if (const auto label = file.label(name)) labels.insert(*label);
        lengths.insert(file.motions().read(name).frames);
    }
    return {{"file", path},
            {"motions", file.motions().names().size()},
            {"classes", labels.size()},
            {"frames", {{"shortest", *lengths.begin()}, {"longest", *lengths.rbegin()}}},
            {"persons", subjects.persons},
            {"joints", subjects.topology.names},
            {"representation", file.motions().representation().name()},
            {"fps", subjects.fps}};
}

void print_motions(const Json& file) {
    const std::uint32_t shortest = file["frames"]["shortest"], longest = file["frames"]["longest"];
    say("{}: a motions file; actformer render draws it\n"
        "  {} of {}, each of {} frames; {} joints in {}, {}, {:g} frames a second\n",
        file["file"].get<std::string>(), counted(file["motions"].get<std::uint64_t>(), "motion"),
        counted(file["classes"].get<std::uint64_t>(), "class"),
        shortest == longest ? std::to_string(longest) : fmt::format("{} to {}", shortest, longest),
        file["joints"].size(), file["representation"].get<std::string>(),
        counted(file["persons"].get<std::uint64_t>(), "person"), file["fps"].get<double>());
}

/// Of each, whether its checksums are of the files' bytes.
std::vector<bool> verify(const std::vector<std::filesystem::path>& folders) {
    std::vector<bool> of_bytes;
    for (const auto& folder : folders) {
        const auto [faults, checksums_of_bytes] = ingest::verify_dataset(folder);
        of_bytes.push_back(checksums_of_bytes);
        for (std::size_t i = 1; i < faults.size(); ++i) remark("{}\n", faults[i]);
        if (!faults.empty())
            throw Error("{}{}; ingest the raw data again", faults[0],
                        faults.size() > 1 ? fmt::format(" ({} more above)", faults.size() - 1) : "");
    }
    return of_bytes;
}

}  // namespace

void add_inspect(CLI::App& app) {
    struct Options {
        std::string dataset;
        bool verify = false, json = false, classes = false;
    };
    auto options = std::make_shared<Options>();
    auto* command = app.add_subcommand("inspect", "Say what is in a dataset, and check that it is whole");
    command->add_option("dataset", options->dataset, "Dataset folder, or a folder of them; or a motions file")
        ->required()
        ->type_name("DATASET|MOTIONS.h5");
    command->add_flag("--verify", options->verify, "Read everything and compare every checksum");
    command->add_flag("--classes", options->classes, "List the classes and their clips");
    command->add_flag("--json", options->json, "Print JSON");
    examples(command,
             "  actformer inspect ntu\n  actformer inspect ntu/ntu-2p --verify --classes\n  actformer "
             "inspect generated.h5\n");
    command->callback([options] {
        if (std::filesystem::is_regular_file(options->dataset)) {
            if (options->verify || options->classes)
                throw Error("{}: a file; --verify and --classes are for datasets", options->dataset);
            const auto file = motions_json(options->dataset);
            if (options->json)
                say_json(file);
            else
                print_motions(file);
            return;
        }
        if (!std::filesystem::exists(options->dataset))
            throw Error("{}: no such file or folder{}", options->dataset, did_you_mean(options->dataset));
        const auto folders = ingest::datasets_at(options->dataset);
        const auto of_bytes = options->verify ? verify(folders) : std::vector<bool>();
        Json json = Json::array();
        for (const auto& folder : folders) {
            const ingest::Dataset dataset(folder);
            if (options->json)
                json.push_back(to_json(dataset));
            else
                print_text(dataset, options->classes);
        }
        if (options->json && options->verify)
            for (std::size_t i = 0; i < json.size(); ++i) {
                json[i]["verified"] = true;
                json[i]["checksums_of"] = of_bytes[i] ? "bytes" : "contents";
            }
        if (options->json) say_json(json.size() == 1 ? json[0] : json);
        if (options->verify && !options->json)
            say("verified: every checksum, offset and number is right; {}\n",
                std::ranges::count(of_bytes, true) > 0
                    ? "checksums are of the files' bytes (format 1: opening a shard for writing breaks them)"
                    : "checksums are of contents");
    });
}

}  // namespace actformer::cli
