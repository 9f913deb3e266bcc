// actformer ingest: raw motion capture to checksummed shards.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files/full_path.hpp"
#include "base/process/shipped.hpp"
#include "base/text/counted.hpp"
#include "base/text/printable.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/format.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/formats/formats.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "ingest/pipeline/record.hpp"

namespace actformer::cli {
namespace {

/// What every ingest takes.
struct IngestOptions {
    std::vector<std::string> raw;
    std::string out, device, origin;
    unsigned threads = 0;
    bool strict = false, json = false;
};

std::string left_out_text(const std::string& kind) {
    if (kind == "broken") return "broken";
    if (kind == "dropped") return "that no dataset here is for (too few persons, another class, no label)";
    if (kind == "missing") return "in the missing list, or not among the files";
    return "of a name that came before";
}

/// As in "train 200, test 74".
std::string splits_text(const ingest::SplitCounts& splits) {
    std::vector<std::string> all;
    for (const auto& [name, clips] : splits) all.push_back(fmt::format("{} {}", name, clips));
    return fmt::format("{}", fmt::join(all, ", "));
}

void print_text(const ingest::IngestSummary& s, const IngestOptions& options) {
    if (s.was_complete) {
        say("{} is complete already: nothing to do\n", options.out);
    } else {
        for (const auto& line : s.made_again) say("{}\n", line);
        if (s.resumed_files) say("went on behind {}\n", counted(s.resumed_files, "finished file"));
        say("read {} ({}) in {}\n", counted(s.files, "file"), bytes(s.text_bytes), duration(s.seconds.wall));
    }
    for (const auto& d : s.datasets) {
        say("  {}: {} of {} in {}, {}, {}\n", d.folder, counted(d.clips, "clip"), counted(d.classes, "class"),
            counted(d.shards, "shard"), counted(d.frames, "frame"), bytes(d.bytes));
        if (s.was_complete) continue;
        if (!d.splits.empty()) say("    clips of splits: {}\n", splits_text(d.splits));
    }
    for (const auto& remark : s.remarks) say("  {}\n", remark);
    for (const auto& doubt : s.doubts) say("  {}\n", to_line(doubt));
    for (const auto& [kind, count] : s.left_out)
        say("  left out: {} {}\n", counted(count, "clip"), left_out_text(kind));
    for (const auto& line : s.first_rejections) say("    {}\n", line);
    if (!s.left_out.empty()) say("  all of them, with reasons: {}/rejected.csv\n", options.out);
}

void print_json(const ingest::IngestSummary& s, const IngestOptions& options) {
    auto made_again = s.made_again;
    for (auto& line : made_again) line = printable(line);
    nlohmann::ordered_json json{{"out", printable(options.out)},
                                {"complete_before", s.was_complete},
                                {"files", s.files},
                                {"resumed_files", s.resumed_files},
                                {"made_again", made_again},
                                {"text_bytes", s.text_bytes},
                                {"left_out", s.left_out},
                                {"remarks", s.remarks},
                                {"seconds", s.seconds.wall}};
    json["doubts"] = ingest::doubts_json(s);
    json["datasets"] = ingest::datasets_json(s);
    for (auto& dataset : json["datasets"])
        dataset["folder"] = printable(dataset["folder"].get_ref<const std::string&>());
    say_json(json);
}

void add_common(CLI::App* command, IngestOptions& options) {
    command
        ->add_option("raw", options.raw,
                     "Folders, files, or archives: .zip, .tar, .tar.gz, .bz2, .xz, .zst, .lz4 or .lz, .7z, "
                     ".rar, .cpio")
        ->required()
        ->type_name("RAW");
    command->add_option("-o,--out", options.out, "Folder to make")->required()->type_name("DIR");
    add_device_option(command, options.device);
    command->add_option("--threads", options.threads, "Threads that read and parse (default: all cores)")
        ->check(CLI::Range(0U, most_threads));
    command
        ->add_option("--origin", options.origin,
                     "What dataset and reports say of the motion: recorded, synthetic or stand-in, which "
                     "`synth` makes "
                     "(default: what RAW's file ORIGIN or the format tells)")
        ->check(CLI::IsMember({"recorded", "synthetic", "stand-in"}));
    command->add_flag("--strict", options.strict, "Stop at the first broken clip in place of skipping it");
    command->add_flag("--json", options.json, "Print the summary as JSON");
}

CLI::Option* add_value(CLI::App* command, const ingest::Option& option) {
    if (auto* const* flag = std::get_if<bool*>(&option.value))
        return command->add_flag(option.flag, **flag, option.help);
    return std::visit([&](auto* value) { return command->add_option(option.flag, *value, option.help); },
                      option.value);
}

void add_own(CLI::App* command, const ingest::Option& option) {
    auto* added = add_value(command, option);
    if (!option.placeholder.empty()) added->type_name(option.placeholder);
    if (!option.choices.empty()) added->check(CLI::IsMember(option.choices));
    if (option.is_required) added->required();
    if (option.shows_default) added->capture_default_str();
    if (std::holds_alternative<std::vector<std::string>*>(option.value))
        added->allow_extra_args(false);  // or it would take the RAW that may follow
    if (option.splits_at_commas) added->delimiter(',');
}

/// The last part of DIR names a format's only dataset.
std::string dataset_name(const std::filesystem::path& out) {
    return printable(full_path(out).filename().string());
}

void run(const IngestOptions& options, const ingest::IngestCommand& command) {
    ingest::IngestRequest request;
    for (const auto& raw : options.raw) request.raw.push_back(here_or_shipped(raw));
    request.out = options.out;
    while (request.out.has_relative_path() && !request.out.has_filename())
        request.out = request.out.parent_path();
    request.strict = options.strict;
    request.one_dataset = command.one_dataset();
    request.threads = options.threads;
    if (!options.origin.empty()) request.origin = ingest::origin_named(options.origin, "--origin");
    const auto format = command.open(dataset_name(request.out));
    kernels::Device device(options.device);
    Progress progress("ingest", "clips");
    request.progress = [&](double fraction, std::uint64_t clips) { progress.update(fraction, clips); };
    const auto summary = ingest::ingest(request, *format, device);
    progress.clear();
    options.json ? print_json(summary, options) : print_text(summary, options);
}

void add_format(CLI::App& ingest, const ingest::FormatEntry& entry) {
    const std::shared_ptr<ingest::IngestCommand> own = entry.command();
    const auto options = std::make_shared<IngestOptions>();
    auto* command = ingest.add_subcommand(std::string(entry.name), std::string(entry.help));
    add_common(command, *options);
    for (const auto& option : own->list()) add_own(command, option);
    examples(command, std::string(entry.examples));
    command->callback([options, own] { run(*options, *own); });
}

}  // namespace

void add_ingest(CLI::App& app) {
    auto* command =
        app.add_subcommand("ingest", "Clean raw motion capture and write it as checksummed HDF5 shards");
    command->require_subcommand(1);
    for (const auto& entry : ingest::formats()) add_format(*command, entry);
}

}  // namespace actformer::cli
