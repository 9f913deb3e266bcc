// actformer sweep: everything that a set of tables needs, trained and scored.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/process/process.hpp"
#include "base/text/counted.hpp"
#include "base/text/loose_json.hpp"
#include "base/threads/parallel.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "cli/shipped_option.hpp"
#include "cli/sweep_jobs.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "reports/sweep/run.hpp"
#include "reports/sweep/split_check.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using reports::JobState;

struct SweepOptions {
    fs::path file, out;
    std::string program, only;
    unsigned jobs = 1;
    std::vector<std::string> sbatch;
    bool dry_run = false, status = false, slurm = false, json = false;
};

/// Every job, what it may cost, and with a dry run its commands.
void print_plan(const reports::Plan& plan, const SweepOptions& options, const SweepJobs& jobs) {
    const auto in_slurm = options.status ? reports::jobs_in_slurm(options.out) : std::nullopt;
    const auto status = reports::statuses(plan, options.out);
    double sum = 0;
    std::size_t unknown = 0, open = 0, dropped = 0;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        const auto& job = plan.jobs[i];
        const auto& s = status[i];
        std::string cost = "time unknown";
        if (s.state == JobState::done) {
            cost = s.seconds ? "took " + duration(*s.seconds) : "";
        } else if (s.state == JobState::failed) {
            ++open;
            cost = "cannot be done";
            if (job.problem.empty()) cost = "failed";
        } else {
            ++open;
            const auto seconds = reports::estimate(plan, status, i);
            if (seconds) cost = "about " + duration(*seconds), sum += *seconds;
            if (!seconds) ++unknown;
        }
        const bool waits = s.state == JobState::waiting;
        const bool queued = waits && in_slurm && in_slurm->contains(job.id);
        dropped += waits && in_slurm && !queued;
        const char* state = queued ? "queued" : waits ? "to do" : name_of(s.state);
        say("{:<8} {:<24} {}  {}{}\n", state, job.id, job.title, cost,
            s.state == JobState::failed ? ": " + s.why : "");
        if (options.dry_run && s.state != JobState::done && s.state != JobState::failed)
            for (const auto& line : jobs.command_lines(job)) say("      {}\n", line);
    }
    say("{} of {} to do", open, counted(plan.jobs.size(), "job"));
    if (sum > 0) say(", about {} of work one after another", duration(sum));
    if (unknown > 0 && open > 0) say("; {} of unknown length", unknown);
    say("\n");
    if (dropped > 0)
        say("{} of them neither done nor in Slurm's queue; --slurm submits them again\n", dropped);
}

/// What a job took, or may take; none of one that failed.
std::optional<double> seconds_of(const reports::Plan& plan, const std::vector<reports::JobStatus>& status,
                                 std::size_t job) {
    if (status[job].state == JobState::failed) return {};
    return status[job].state == JobState::done ? status[job].seconds : reports::estimate(plan, status, job);
}

/// [{"id", "title", "state", "seconds": that it took, or may take, "why": it cannot be done, "commands"}]
Json jobs_json(const reports::Plan& plan, const SweepOptions& options, const SweepJobs& jobs) {
    const auto in_slurm = options.status ? reports::jobs_in_slurm(options.out) : std::nullopt;
    const auto status = reports::statuses(plan, options.out);
    Json out = Json::array();
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        const auto& job = plan.jobs[i];
        const bool queued = status[i].state == JobState::waiting && in_slurm && in_slurm->contains(job.id);
        Json one{
            {"id", job.id}, {"title", job.title}, {"state", queued ? "queued" : name_of(status[i].state)}};
        if (const auto seconds = seconds_of(plan, status, i)) one["seconds"] = *seconds;
        if (!status[i].why.empty()) one["why"] = status[i].why;
        one["commands"] = jobs.command_lines(job);
        out.push_back(std::move(one));
    }
    return out;
}

/// Rows that failed, each with its reason once. The number of them.
std::size_t print_rows(const reports::Sweep& sweep, const reports::Plan& plan, const SweepOptions& options) {
    const auto results = reports::results(sweep, plan, options.out);
    std::size_t done = 0, failed = 0;
    for (const auto& row : results["rows"]) {
        done += row["status"] == "done";
        if (row["status"] != "failed") continue;
        ++failed;
        say("failed: {}: {}\n", row["name"].get<std::string>(), row["why"].get<std::string>());
    }
    const auto file = options.out / "results.json";
    say("{} of {} done{}\n", done, counted(results["rows"].size(), "row"),
        fs::exists(file) ? "; " + file.string() : "");
    return failed;
}

/// This command again for one job, for Slurm, which may run it on another machine with the same file system.
std::vector<std::string> again(const SweepOptions& options, const reports::Job& job) {
    return {(program_folder() / "actformer").string(),
            "sweep",
            fs::absolute(options.file).string(),
            "-o",
            fs::absolute(options.out).string(),
            "--program",
            options.program,
            "--only",
            job.id};
}

/// Jobs that run at once have the processor's threads between them. Whoever sets OMP_NUM_THREADS is left alone.
void share_threads(unsigned jobs) {
    if (jobs > 1)
        ::setenv("OMP_NUM_THREADS", std::to_string(std::max(1U, thread_count(0) / jobs)).c_str(), 0);
}

void run_here(const reports::Sweep& sweep, const reports::Plan& plan, const SweepOptions& options,
              const SweepJobs& jobs) {
    share_threads(options.jobs);
    const auto status =
        reports::run_plan(sweep, plan, {options.out, jobs, options.jobs}, told_events(options.out));
    if (options.json)
        say_json(reports::results(sweep, plan, options.out));
    else
        print_rows(sweep, plan, options);
    const auto failed = std::count_if(status.begin(), status.end(),
                                      [](const auto& s) { return s.state == JobState::failed; });
    if (failed > 0)
        throw Error(
            "{}: {} of {} failed or could not begin; the rest is done, and the same command tries them again",
            options.file.string(), failed, counted(plan.jobs.size(), "job"));
}

/// After a dry run has told them one by one.
void refuse_what_cannot_be_done(const reports::Plan& plan, const fs::path& file) {
    const auto count = std::ranges::count_if(plan.jobs, [](const auto& job) { return !job.problem.empty(); });
    if (count > 0)
        throw Error("{}: {} of {} cannot be done; the lines above say why", file.string(), count,
                    counted(plan.jobs.size(), "job"));
}

/// The sweep would replace them. Damaged ones are written anew.
void refuse_results_of_others(const reports::Sweep& sweep, const SweepOptions& options) {
    const auto held = loose::read(options.out / "results.json");
    if (own_checksum_of(held) == OwnChecksum::wrong) return;
    const auto out = options.out.string(), name = loose::text(held, "sweep");
    if (loose::member(held, "comparison") == Json(true))
        throw Error("{}: holds a comparison, not the sweep '{}'; choose another -o", out, sweep.name);
    if (!name.empty() && name != sweep.name)
        throw Error(
            "{}: holds the sweep '{}', not '{}'; choose another -o, or write `name: {}` into {} if it is "
            "the same sweep",
            out, name, sweep.name, name, options.file.string());
}

/// As the system finds it: a name without a slash lies in a folder of PATH.
void expect_program(const std::string& program) {
    const auto can_be_run = [](const fs::path& file) {
        std::error_code unread;
        return fs::is_regular_file(file, unread) && ::access(file.c_str(), X_OK) == 0;
    };
    if (program.find('/') != std::string::npos) {
        if (!can_be_run(program))
            throw Error("--program: {} cannot be run; give an executable file", program);
        return;
    }
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (can_be_run(fs::path(folder) / program)) return;
    throw Error("--program: there is no program {} in PATH; give its path", program);
}

void run(SweepOptions options) {
    if (options.program.empty()) options.program = (program_folder() / "actformer").string();
    expect_program(options.program);
    options.out = fs::absolute(options.out).lexically_normal();
    ingest::refuse_other_folder(options.out, ingest::own::sweep);
    const auto sweep = reports::read_sweep(options.file);
    refuse_results_of_others(sweep, options);
    const SweepJobs jobs(options.program, options.out);
    auto plan = reports::make_plan(sweep, options.file.parent_path(), options.out, jobs);
    SweepJobs::check_stand_ins(plan.jobs);
    if (options.only.empty() && !options.status) reports::check_splits(options.file, plan, options.out);
    if (options.dry_run) {
        SweepJobs::check_trainings(plan.jobs);
        SweepJobs::check_ingests(plan.jobs);
    }
    if (!options.only.empty()) {
        const auto status = reports::run_one(sweep, plan, options.only, {options.out, jobs});
        if (status.state != JobState::done) throw Error("{}: {}", options.only, status.why);
        return;
    }
    if (options.slurm && !options.dry_run) {
        const auto count = reports::submit_plan(
            sweep, plan, {options.out, jobs}, [&](const reports::Job& job) { return again(options, job); },
            options.sbatch, told_events(options.out).again);
        if (options.json)
            say_json(Json{{"submitted", count}});
        else
            say("{} submitted; follow them with actformer sweep {} -o {} --status\n", counted(count, "job"),
                options.file.string(), options.out.string());
        return;
    }
    if (options.dry_run || options.status) {
        if (options.json) {
            auto json = reports::results(sweep, plan, options.out);
            json["jobs"] = jobs_json(plan, options, jobs);
            say_json(json);
        } else {
            print_plan(plan, options, jobs);
            if (options.status) print_rows(sweep, plan, options);
        }
        if (options.dry_run) refuse_what_cannot_be_done(plan, options.file);
        return;
    }
    run_here(sweep, plan, options, jobs);
}

}  // namespace

void add_sweep(CLI::App& app) {
    auto options = std::make_shared<SweepOptions>();
    auto* command = app.add_subcommand("sweep", "Train and score everything that a set of tables needs");
    takes_shipped(command->add_option("sweep", options->file,
                                      "Datasets, recognisers and rows: a file, or the name of one that comes "
                                      "with the program"),
                  "reports/sweeps")
        ->required()
        ->type_name("SWEEP.yaml");
    lists_shipped(command, "reports/sweeps");
    command->add_option("-o,--out", options->out, "Folder of all it makes")->required()->type_name("DIR");
    command->add_option("--jobs", options->jobs, "Jobs at once, with the processor's threads between them")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_flag("--dry-run", options->dry_run,
                      "Check every key; print the jobs, their commands and what they may cost");
    command->add_flag("--status", options->status, "Print how far it is, here or on Slurm");
    auto* slurm = command->add_flag("--slurm", options->slurm, "Submit the jobs through sbatch");
    command->add_option("--sbatch", options->sbatch, "A word for every sbatch, as in --sbatch=--gres=gpu:1")
        ->needs(slurm)
        ->type_name("WORD");
    command->add_option("--only", options->only, "Run one job alone; what it needs must be done")
        ->type_name("JOB");
    command->add_option("--program", options->program, "The actformer that does the jobs (default: this one)")
        ->type_name("PROGRAM");
    command->add_flag("--json", options->json,
                      "Print the results as JSON; of --dry-run and --status with the jobs");
    examples(command,
             "  actformer sweep                                        which sweeps come with the program\n"
             "  actformer sweep mini -o mini --dry-run\n"
             "  actformer sweep mine.yaml -o mine --jobs 2\n"
             "  actformer sweep table3 -o tables --slurm --sbatch=--gres=gpu:1\n"
             "Interrupted, the same command goes on where it was. A row that fails stops no other.\n");
    command->callback([options, command] {
        if (options->slurm) refuse_given(*command, {"--jobs"}, "Slurm decides how many run at once");
        if (!options->only.empty())
            refuse_given(*command, {"--json", "--dry-run", "--status", "--slurm", "--jobs"},
                         "--only runs a single job here");
        if (options->status)
            refuse_given(*command, {"--slurm", "--dry-run", "--jobs"},
                         "--status tells of all jobs, here and on Slurm, and runs none");
        run(*options);
    });
}

}  // namespace actformer::cli
