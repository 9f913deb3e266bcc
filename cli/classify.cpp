// actformer classify: the actions of clips without labels.
#include "eval/scoring/classify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/files/file.hpp"
#include "base/files/output.hpp"
#include "base/text/counted.hpp"
#include "base/text/csv.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/format.hpp"
#include "cli/motion_options.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/export/foreign.hpp"

namespace actformer::cli {
namespace {

using Clips = std::vector<eval::Classified>;
using Names = std::vector<std::string>;

constexpr std::string_view csv_heading =
    "clip,windows,class,name,probability,runner_up,runner_up_probability\n";

struct ClassifyOptions : MotionOptions {
    std::filesystem::path out;
    bool force = false, json = false;
};

std::string csv(const Clips& clips, const Names& names) {
    std::string out(csv_heading);
    for (const auto& clip : clips) {
        out += fmt::format("{},{},{},{},{:.6f},", csv_cell(clip.clip), clip.windows, clip.best.label + 1,
                           csv_cell(names[clip.best.label]), clip.best.probability);
        if (clip.runner_up)
            out +=
                fmt::format("{},{:.6f}", csv_cell(names[clip.runner_up->label]), clip.runner_up->probability);
        else
            out += ",";
        out += "\n";
    }
    return out;
}

nlohmann::ordered_json to_json(const Clips& clips, const Names& names) {
    const auto guess = [&](const eval::Guess& g) {
        return nlohmann::ordered_json{
            {"class", g.label + 1}, {"name", names[g.label]}, {"probability", g.probability}};
    };
    auto out = nlohmann::ordered_json::array();
    for (const auto& clip : clips) {
        nlohmann::ordered_json one{{"clip", clip.clip}, {"windows", clip.windows}};
        one.update(guess(clip.best));
        one["runner_up"] = clip.runner_up ? guess(*clip.runner_up) : nullptr;
        out.push_back(std::move(one));
    }
    return out;
}

void print_table(const Clips& clips, const Names& names) {
    std::size_t clip_width = 4, name_width = 5;
    for (const auto& clip : clips) clip_width = std::max(clip_width, clip.clip.size());
    for (const auto& name : names) name_width = std::max(name_width, name.size());
    say("{:<{}}  {:<{}}  probability  runner-up\n", "clip", clip_width, "class", name_width);
    for (const auto& clip : clips) {
        say("{:<{}}  {:<{}}  {:>9.1f} %", clip.clip, clip_width, names[clip.best.label], name_width,
            100 * clip.best.probability);
        if (clip.runner_up)
            say("  {}, {:.1f} %", names[clip.runner_up->label], 100 * clip.runner_up->probability);
        say("\n");
    }
}

/// Says that it did, but of a stream, as standard output.
void write_csv(const std::filesystem::path& path, const Clips& clips, const Names& names) {
    const auto text = csv(clips, names);
    write_whole(path, text);
    if (!output_at(path).stream)
        remark("{}: {}, {}\n", path.string(), counted(clips.size(), "clip"), bytes(text.size()));
}

void run(const ClassifyOptions& options) {
    if (!options.out.empty()) check_output(options.out);
    if (!options.force)
        ingest::refuse_foreign(options.out, "classes",
                               [](std::string_view bytes) { return bytes.starts_with(csv_heading); });
    kernels::Device device(options.device);
    eval::FeatureExtractor extractor(device, options.recogniser, options.batch);
    const auto motions = options.open(device, extractor);
    Progress progress("classify", "sequences", options.json);
    const auto clips = eval::classify(*motions, extractor, [&](std::uint64_t done, std::uint64_t all) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), done);
    });
    progress.clear();
    const auto names = class_names(extractor.recogniser(), motions->info());
    if (!options.out.empty()) write_csv(options.out, clips, names);
    if (options.json)
        say_json(to_json(clips, names));
    else
        print_table(clips, names);
}

}  // namespace

void add_classify(CLI::App& app) {
    auto options = std::make_shared<ClassifyOptions>();
    auto* command = app.add_subcommand("classify", "The actions of clips without labels");
    add_motion_options(command, *options);
    command->add_option("-o,--out", options->out, "The table as a CSV file")
        ->type_name("CLASSES.csv")
        ->check(ends_in(".csv"));
    add_force_option(command, options->force);
    command->add_flag("--json", options->json, "Print JSON");
    examples(
        command,
        "  actformer classify --recogniser run captured -o classes.csv\n"
        "  actformer classify --recogniser run generated.h5 --json\n"
        "A dataset's clips are cut into windows; a clip's class is that of the mean of its windows' logits.\n"
        "Classes are called by the names that the recogniser learnt, and numbered from 1.\n");
    command->callback([options] { run(*options); });
}

}  // namespace actformer::cli
