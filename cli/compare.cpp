// actformer compare: two generators, or two files of motions, beside the same real motions.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/full_path.hpp"
#include "base/hdf5/reader.hpp"
#include "base/process/process.hpp"
#include "base/process/shipped.hpp"
#include "base/text/loose_json.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/format.hpp"
#include "cli/report.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "cli/sweep_jobs.hpp"
#include "eval/metrics/interval.hpp"
#include "eval/metrics/metric.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "reports/page/measured.hpp"
#include "reports/page/tables.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct CompareOptions {
    fs::path a, b, recogniser, real, out;
    std::string split = "all", device;
    std::uint64_t repeats = 20, per_class = 100, window = 60;
    bool json = false;
};

/// What both sides have of a metric, as tables print it.
struct Compared {
    const eval::Metric* metric = nullptr;
    eval::Interval a, b;
    eval::Interval difference;   ///< of B less A, seed by seed
    std::optional<double> real;  ///< of real motions
    std::optional<eval::Interval>
        further;  ///< how much further than A's B's values are from it, where nearest is best
    std::optional<bool> b_better;  ///< where the interval says so
};

/// Weights name their method; motions do not.
bool holds_motions(const fs::path& path) {
    return fs::is_regular_file(path) && ingest::own_kind(hdf5::Reader(path)) != ingest::own::generator;
}

/// Before anything is scored.
void check_inputs(const CompareOptions& options) {
    for (const auto& path : {options.a, options.b})
        if (const auto kind = ingest::other_kind(path, ingest::own::generator); !kind.empty())
            throw Error("{}: {}; a generator (a training or weights) or a motions file is expected",
                        path.string(), kind);
    ingest::Dataset(ingest::one_dataset_at(options.real)).split(options.split);
}

/// Without the name that the command which failed begins its line with.
std::string why_of(const reports::JobStatus& status) {
    const std::string name = "actformer: ";
    return status.why.starts_with(name) ? status.why.substr(name.size()) : status.why;
}

/// As much of the end of `path` as tells it from `other`.
std::string name_beside(const fs::path& path, const fs::path& other) {
    auto rest = full_path(path), against = full_path(other);
    auto name = printable(rest.filename().string());
    if (rest == against) return name;
    while (rest.filename() == against.filename()) {
        rest = rest.parent_path();
        against = against.parent_path();
        if (!rest.has_filename()) break;
        name += " of " + printable(rest.filename().string());  // names of tables' rows hold no /
    }
    return name;
}

/// The last part of a path, also of "." and "cmu/".
std::string last_part(const fs::path& path) {
    return printable(full_path(path).filename().string());
}

/// How the name of every comparison's sweep begins; reports tell them apart by their folders.
const std::string comparison_in = "comparison in ";

reports::SweepRow side(const char* letter, const fs::path& path, const fs::path& other,
                       const CompareOptions& options) {
    reports::SweepRow row;
    row.name = fmt::format("{}, {}", letter, name_beside(path, other));
    row.data = last_part(options.real);
    row.recogniser = "recogniser";
    row.split = printable(options.split);  // as a dataset takes it too
    row.device = options.device;
    row.repeats = options.repeats;
    row.per_class = options.per_class;
    row.window = options.window;
    if (holds_motions(path))
        row.motions = {path.string()};
    else
        row.weights = path.string();
    return row;
}

reports::Sweep comparison(const CompareOptions& options) {
    reports::Sweep sweep;
    sweep.name = comparison_in + last_part(options.out);
    sweep.comparison = true;
    sweep.datasets[last_part(options.real)].path = options.real.string();
    sweep.recognisers["recogniser"].weights = options.recogniser.string();
    sweep.rows = {side("A", options.a, options.b, options), side("B", options.b, options.a, options)};
    return sweep;
}

std::vector<double> repeats_of(const Json& scores, const eval::Metric& metric) {
    std::vector<double> values;
    for (const auto& value : loose::list(loose::member(scores, std::string(metric.name).c_str()), "repeats"))
        if (value.is_number()) values.push_back(metric.scale * value.get<double>());
    return values;
}

/// Every value's distance from the best one that there is.
std::vector<double> distances(const std::vector<double>& values, const Compared& of) {
    std::vector<double> out;
    for (const double value : values)
        out.push_back(reports::distance_from_best(of.metric->direction, value, of.real.value_or(0)));
    return out;
}

/// None where one side was not scored with the metric, or with another number of repeats.
std::optional<Compared> compared(const Json& a, const Json& b, const eval::Metric& metric) {
    Compared out;
    out.metric = &metric;
    const auto of_a = repeats_of(a, metric), of_b = repeats_of(b, metric);
    if (of_a.empty() || of_a.size() != of_b.size()) return {};
    out.a = eval::interval(of_a);
    out.b = eval::interval(of_b);
    out.difference = eval::paired_difference(of_a, of_b);
    if (const auto& real = loose::member(loose::member(a, "real"), std::string(metric.name).c_str());
        real.is_number())
        out.real = metric.scale * real.get<double>();
    if (metric.direction == eval::Direction::nearest_real && !out.real) return out;
    const auto further = eval::paired_difference(distances(of_a, out), distances(of_b, out));
    if (further.half_width && std::abs(further.mean) > *further.half_width) out.b_better = further.mean < 0;
    if (metric.direction == eval::Direction::nearest_real) out.further = further;
    return out;
}

std::vector<Compared> all_compared(const Json& a, const Json& b) {
    std::vector<Compared> out;
    for (const auto& metric : eval::metrics())
        if (auto one = compared(a, b, metric)) out.push_back(*one);
    return out;
}

std::string text_of(const eval::Interval& interval, bool with_sign = false) {
    const auto mean = with_sign && interval.mean > 0 ? "+" + reports::figure_text(interval.mean)
                                                     : reports::figure_text(interval.mean);
    return interval.half_width ? mean + " ± " + reports::figure_text(*interval.half_width) : mean;
}

std::string verdict(const Compared& one) {
    if (!one.difference.half_width) return "one repeat: chance is not told";
    const std::string found = !one.b_better   ? "no difference shown"
                              : *one.b_better ? "B is better"
                                              : "A is better";
    return one.further ? found + ": distance from real " + text_of(*one.further, true) : found;
}

/// What `score` warned of, once where it is the same of both sides.
std::vector<std::string> warnings_of(const Json& a, const Json& b) {
    const auto of = [](const Json& scores) {
        std::vector<std::string> lines;
        for (const auto& warning : loose::list(scores, "warnings"))
            if (warning.is_string()) lines.push_back(warning.get<std::string>());
        return lines;
    };
    const auto of_a = of(a), of_b = of(b);
    std::vector<std::string> out;
    for (const auto& line : of_a) out.push_back(std::ranges::count(of_b, line) > 0 ? line : "A: " + line);
    for (const auto& line : of_b)
        if (std::ranges::count(of_a, line) == 0) out.push_back("B: " + line);
    return out;
}

void print(const std::vector<Compared>& all, const std::vector<std::string>& warnings,
           const reports::Sweep& sweep) {
    for (const auto& row : sweep.rows) say("{}\n", row.name);
    say("\n{:<18} {:>18} {:>18} {:>18} {:>9}\n", "", "A", "B", "B - A", "real");
    for (const auto& one : all)
        say("{:<18} {:>18} {:>18} {:>18} {:>9}   {}\n", eval::heading_with_unit(*one.metric), text_of(one.a),
            text_of(one.b), text_of(one.difference, true), one.real ? reports::figure_text(*one.real) : "",
            verdict(one));
    say("\nintervals of 95 %, of differences seed by seed\n");
    for (const auto& warning : warnings) say("warning: {}\n", warning);
}

Json to_json(const eval::Interval& interval) {
    Json out{{"mean", interval.mean}};
    if (interval.half_width) out["ci95"] = *interval.half_width;
    return out;
}

/// A motions file is one repeat.
Json inputs_json(const CompareOptions& options) {
    return {{"a", options.a.string()},
            {"b", options.b.string()},
            {"recogniser", options.recogniser.string()},
            {"real", options.real.string()},
            {"split", printable(options.split)},
            {"repeats", holds_motions(options.a) ? 1 : options.repeats}};
}

Json to_json(const CompareOptions& options, const std::vector<Compared>& all,
             const std::vector<std::string>& warnings, const fs::path& page) {
    Json metrics = Json::object();
    for (const auto& one : all) {
        auto& entry = metrics[std::string(one.metric->name)];
        entry = {{"a", to_json(one.a)}, {"b", to_json(one.b)}, {"difference", to_json(one.difference)}};
        if (one.real) entry["real"] = *one.real;
        if (one.further) entry["distance_from_real"] = to_json(*one.further);
        entry["better"] = one.b_better ? Json(*one.b_better ? "b" : "a") : Json();
    }
    auto json = inputs_json(options);
    json["metrics"] = metrics;
    json["warnings"] = warnings;
    json["report"] = page.string();
    return json;
}

/// As a table may be called, and another for each folder.
std::string table_id(const fs::path& out) {
    Checksum folder;
    folder.add(full_path(out).string());
    return "comparison-" + folder.hex().substr(0, 8);
}

/// The table that stands first in the report: both sides, with the metrics that they have.
void add_table(reports::Sweep& sweep, const std::vector<Compared>& all, const fs::path& out) {
    const auto id = table_id(out);
    const auto& dataset = sweep.rows[0].data;
    Json names = Json::array(), rows = Json::object();
    for (const auto& one : all) names.push_back(one.metric->name);
    for (auto& row : sweep.rows) {
        rows[row.name] = Json::object();
        row.fills = {id + "/" + row.name + "/" + dataset};
    }
    const Json table{{"title", "Comparison in " + last_part(out)},
                     {"columns", Json::array({{{"dataset", dataset}, {"metrics", names}}})},
                     {"rows", rows}};
    sweep.tables = Json{{id, table}}.dump();  // JSON is YAML
}

/// A folder that holds something else would lose it, or be taken for the comparison.
void refuse_other_than_comparisons(const fs::path& out) {
    if (!fs::exists(out / "results.json")) {
        ingest::refuse_other_folder(out, "a comparison");
        if (fs::exists(out / "report.html"))
            throw Error("{}: holds a report.html, and no comparison; choose another -o", out.string());
        return;
    }
    const auto name = loose::text(loose::read(out / "results.json"), "sweep");
    if (!name.starts_with(comparison_in))
        throw Error("{}: holds the sweep '{}'; choose another -o", out.string(), name);
}

/// Differences are taken seed by seed, and a motions file is of one.
void refuse_a_mixed_pair(const CompareOptions& options) {
    if (!fs::exists(options.a) || !fs::exists(options.b) || options.repeats == 1) return;  // said elsewhere
    const bool a_holds = holds_motions(options.a), b_holds = holds_motions(options.b);
    if (a_holds == b_holds) return;
    throw Error(
        "{} is a generator and {} a motions file, which is one repeat; compare two generators (trainings or "
        "weights) or two motions files, or give --repeats 1",
        (a_holds ? options.b : options.a).string(), (a_holds ? options.a : options.b).string());
}

/// As a sweep tells them, but for the time left where no scoring has been measured: a guess of so little work is far off.
reports::SweepEvents events_told(const fs::path& out) {
    auto events = told_events(out);
    const auto scored = std::make_shared<std::atomic<bool>>(false);
    events.begins = [scored, begins = events.begins](const reports::Job& job, reports::SweepProgress now) {
        if (!*scored) now.seconds_left.reset();
        begins(job, now);
    };
    events.ends = [scored, ends = events.ends](const reports::Job& job, const reports::JobStatus& status) {
        if (std::holds_alternative<reports::ScoringWork>(job.work)) *scored = true;
        ends(job, status);
    };
    return events;
}

void run(const CompareOptions& options) {
    check_inputs(options);
    refuse_a_mixed_pair(options);
    const auto out = fs::absolute(options.out).lexically_normal();
    refuse_other_than_comparisons(out);
    auto sweep = comparison(options);
    const SweepJobs jobs((program_folder() / "actformer").string(), out);
    const auto plan = reports::make_plan(sweep, {}, out, jobs);
    for (const auto& job : plan.jobs)
        if (!job.problem.empty()) throw Error("{}", job.problem);
    for (const auto& status : reports::run_plan(sweep, plan, {out, jobs}, events_told(out)))
        if (status.state != reports::JobState::done) throw Error("{}", why_of(status));
    const auto measured = reports::read_measured({out});
    const auto &a = measured.rows[0].runs[0].scored, &b = measured.rows[1].runs[0].scored;
    const auto all = all_compared(a, b);
    if (all.empty())
        throw Error("{} and {}: no metric that both have", options.a.string(), options.b.string());
    const auto warnings = warnings_of(a, b);
    add_table(sweep, all, out);
    reports::write_results(sweep, plan, out);
    write_report({.folders = {out},
                  .out = out / "report.html",
                  .title = "A comparison",
                  .force = true,
                  .filled_only = true});
    if (options.json)
        say_json(to_json(options, all, warnings, out / "report.html"));
    else
        print(all, warnings, sweep);
}

}  // namespace

void add_compare(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    auto* command = app.add_subcommand(
        "compare", "Score two generators, or two motions files, and test their differences");
    command->add_option("a", options->a, "A generator (a training or weights), or a motions file")
        ->required();
    command->add_option("b", options->b, "Another of the same: two generators or two motions files")
        ->required();
    command->add_option("--recogniser", options->recogniser, "Training or weights of a recogniser")
        ->required();
    command->add_option("--real", options->real, "Dataset of real motions")->required()->type_name("DATASET");
    command->add_option("--split", options->split, "Split of the real dataset")->capture_default_str();
    command->add_option("--repeats", options->repeats, "Number of seeds to generate with")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    command->add_option("--per-class", options->per_class, "Motions of a class")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    command->add_option("--window", options->window, "Frames a window of the real motions")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    add_device_option(command, options->device);
    command
        ->add_option("-o,--out", options->out,
                     "Folder of scores, features and report.html, whose viewer shows real motions, A's and "
                     "B's together")
        ->required()
        ->type_name("DIR");
    command->add_flag("--json", options->json, "Print JSON");
    examples(
        command,
        "  actformer compare generator-a generator-b --recogniser recogniser --real cmu --split train -o "
        "comparison\n"
        "  actformer compare weights/cmu/actformer.h5 my-training --recogniser weights/cmu/recogniser.h5 "
        "--real "
        "cmu -o c\n"
        "  actformer compare old.h5 new.h5 --recogniser recogniser --real cmu -o motions-compared\n"
        "Differences are taken seed by seed. A difference whose 95 % interval contains 0 is not "
        "significant. Where nearest to real is best, distances from real are compared.\n");
    command->callback([options, command] {
        options->a = here_or_shipped(options->a);
        options->b = here_or_shipped(options->b);
        if (holds_motions(options->a) && holds_motions(options->b))
            refuse_given(*command, {"--repeats", "--per-class"}, "motions files are scored as they are");
        run(*options);
    });
}

}  // namespace actformer::cli
