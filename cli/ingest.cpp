// actformer ingest: raw motion capture to checksummed shards.
#include "cli/ingest.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/format.hpp"
#include "cli/progress.hpp"

namespace actformer::cli {
namespace {

std::string left_out_text(const std::string& kind) {
    if (kind == "broken") return "broken";
    if (kind == "dropped") return "that no dataset here is for (too few persons, or another class)";
    if (kind == "missing") return "in the missing list";
    return "of a name that came before";
}

void print_text(const ingest::IngestSummary& s, const IngestOptions& options) {
    if (s.was_complete) {
        fmt::print("{} is complete already: nothing to do\n", options.out);
    } else {
        if (s.resumed_files) fmt::print("went on behind {}\n", counted(s.resumed_files, "finished file"));
        fmt::print("read {} ({}) in {}\n", counted(s.files, "file"), bytes(s.text_bytes),
                   duration(s.seconds.wall));
    }
    for (const auto& d : s.datasets)
        fmt::print("  {}: {} of {} in {}, {}, {}\n", d.folder, counted(d.clips, "clip"),
                   counted(d.classes, "class"), counted(d.shards, "shard"), counted(d.frames, "frame"),
                   bytes(d.bytes));
    for (const auto& [kind, count] : s.left_out)
        fmt::print("  left out: {} {}\n", counted(count, "file"), left_out_text(kind));
    for (const auto& line : s.first_rejections) fmt::print("    {}\n", line);
    if (!s.left_out.empty()) fmt::print("  all of them, with reasons: {}/rejected.csv\n", options.out);
}

void print_json(const ingest::IngestSummary& s, const IngestOptions& options) {
    nlohmann::ordered_json json{{"out", options.out},         {"complete_before", s.was_complete},
                                {"files", s.files},           {"resumed_files", s.resumed_files},
                                {"text_bytes", s.text_bytes}, {"left_out", s.left_out},
                                {"seconds", s.seconds.wall}};
    json["datasets"] = nlohmann::ordered_json::array();
    for (const auto& d : s.datasets)
        json["datasets"].push_back({{"folder", d.folder},
                                    {"clips", d.clips},
                                    {"classes", d.classes},
                                    {"frames", d.frames},
                                    {"shards", d.shards},
                                    {"bytes", d.bytes}});
    fmt::print("{}\n", json.dump(2));
}

}  // namespace

void add_ingest_options(CLI::App* command, IngestOptions& options) {
    command->add_option("raw", options.raw, "Folders, files, .zip or .tar.* archives")
        ->required()
        ->type_name("RAW");
    command->add_option("-o,--out", options.out, "Folder to make")->required()->type_name("DIR");
    command->add_option("--device", options.device, "OpenCL device: a number, gpu, cpu, or part of a name");
    command->add_option("--threads", options.threads, "Threads that read and parse (default: all cores)");
    command->add_flag("--strict", options.strict, "Stop at the first broken clip in place of skipping it");
    command->add_flag("--json", options.json, "Print the summary as JSON");
}

void run_ingest(const IngestOptions& options, const ingest::Format& format, bool one_dataset,
                std::unordered_set<std::string> missing) {
    kernels::Device device(options.device);
    Progress progress("ingest", "clips");
    ingest::IngestRequest request;
    request.raw.assign(options.raw.begin(), options.raw.end());
    request.out = options.out;
    while (request.out.has_relative_path() && !request.out.has_filename())
        request.out = request.out.parent_path();
    request.missing = std::move(missing);
    request.strict = options.strict;
    request.one_dataset = one_dataset;
    request.threads = options.threads;
    request.progress = [&](double fraction, std::uint64_t clips) { progress.update(fraction, clips); };
    const auto summary = ingest::ingest(request, format, device);
    progress.clear();
    options.json ? print_json(summary, options) : print_text(summary, options);
}

void add_ingest(CLI::App& app) {
    auto* command =
        app.add_subcommand("ingest", "Clean raw motion capture and write it as checksummed HDF5 shards");
    command->require_subcommand(1);
    add_ingest_ntu(*command);
    add_ingest_bvh(*command);
}

}  // namespace actformer::cli
