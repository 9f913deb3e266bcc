#include "cli/sweep_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/scratch.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "cli/program.hpp"
#include "cli/progress.hpp"
#include "cli/say.hpp"
#include "ingest/synth/stand_in.hpp"
#include "reports/sweep/plan.hpp"

namespace actformer::cli {
namespace {

using namespace reports;
using Words = std::vector<std::string>;

/// Stands for actformer, so that a job is the same wherever the program lies.
const std::string program = "{program}";

/// `option` and its value, where there is one.
void add_option(Words& words, const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
}

/// The commands that do a job's work, one after another. What they say is part of the job's fingerprint: other words make work that was
/// done before begin anew.
struct Commands {
    std::vector<Words> operator()(const IngestWork& work) const {
        std::vector<Words> out;
        Words ingest{program, "ingest", work.format};
        if (work.clips > 0) {
            out.push_back({program, "synth", work.format, "-o", work.synthetic, "--clips",
                           std::to_string(work.clips), "--seed", std::to_string(work.seed)});
            add_option(out[0], "--actions", work.actions);
            ingest.push_back(work.synthetic);
        }
        ingest.insert(ingest.end(), work.raw.begin(), work.raw.end());
        ingest.insert(ingest.end(), {"-o", work.out});
        ingest.insert(ingest.end(), work.arguments.begin(), work.arguments.end());
        out.push_back(std::move(ingest));
        return out;
    }

    std::vector<Words> operator()(const TrainingWork& work) const {
        Words words{program, "train", work.network, "-c", work.config, "--data", work.data, "-o", work.out};
        for (const auto& [key, value] : work.set) words.push_back(key + "=" + value);
        return {words};
    }

    std::vector<Words> operator()(const GenerationWork& work) const {
        Words words{program,       "generate",
                    "--generator", work.generator,
                    "-o",          work.out,
                    "--per-class", std::to_string(work.per_class),
                    "--seed",      std::to_string(work.seed)};
        add_option(words, "--device", work.device);
        return {words};
    }

    std::vector<Words> operator()(const ScoringWork& work) const {
        Words words{program, "score"};
        add_option(words, "--recogniser", work.recogniser);
        words.insert(words.end(),
                     {"--real", work.data, "--split", work.split, "--window", std::to_string(work.window)});
        add_option(words, "--single-recogniser", work.single_recogniser);
        add_option(words, "--device", work.device);
        if (work.motions.empty()) {
            words.insert(words.end(),
                         {"--generator", work.generator, "--repeats", std::to_string(work.repeats),
                          "--per-class", std::to_string(work.per_class)});
            add_option(words, "--generate-on", work.generate_on);
        } else {
            words.emplace_back("--generated");
            words.insert(words.end(), work.motions.begin(), work.motions.end());
        }
        words.insert(words.end(), {"-o", work.out, "--keep-features", work.features});
        return {words};
    }

    std::vector<Words> operator()(const MissingWork& work) const { return {{work.what, work.path}}; }
};

}  // namespace

std::vector<std::string> SweepJobs::identity(const Work& work) const {
    Words out;
    for (const auto& words : std::visit(Commands{}, work)) out.insert(out.end(), words.begin(), words.end());
    return out;
}

std::vector<std::vector<std::string>> SweepJobs::commands(const Job& job) const {
    auto out = std::visit(Commands{}, job.work);
    for (auto& words : out)
        for (auto& word : words) word = word == program ? program_ : filled_in(word, out_, job);
    return out;
}

std::vector<std::string> SweepJobs::command_lines(const Job& job) const {
    std::vector<std::string> lines;
    for (const auto& words : commands(job)) lines.push_back(command_line(words));
    return lines;
}

std::string SweepJobs::run(const Job& job, const std::filesystem::path& log) const {
    for (const auto& words : commands(job)) {
        const auto result = run_process(words, log);
        if (result.exit != 0)
            return result.last_line.empty()
                       ? fmt::format("{}: exit code {}", command_line(words), result.exit)
                       : result.last_line;
    }
    return {};
}

reports::SweepEvents told_events(const std::filesystem::path& out) {
    SweepEvents events;
    events.again = [](const Job& job, const std::string& why) {
        remark("again:  {} ({}): {}\n", job.title, job.id, why);
    };
    events.begins = [](const Job& job, const SweepProgress& now) {
        const auto left = now.seconds_left ? ", about " + duration(*now.seconds_left) + " left" : "";
        remark("begins: [{}/{}] {} ({}){}\n", now.begun, now.jobs, job.title, job.id, left);
    };
    events.ends = [out](const Job& job, const JobStatus& status) {
        if (status.state == JobState::done)
            remark("done:   {}{}\n", job.title, status.seconds ? ", " + duration(*status.seconds) : "");
        else
            remark("failed: {}: {}; see {}\n", job.title, status.why,
                   (folder_of(out, job) / "log.txt").string());
    };
    return events;
}

void SweepJobs::check_stand_ins(std::vector<Job>& jobs) {
    std::vector<std::string_view> known{"ntu"};
    for (const auto& one : ingest::synth::stand_ins()) known.push_back(one.name);
    for (auto& job : jobs) {
        const auto* work = std::get_if<IngestWork>(&job.work);
        if (!work || work->clips == 0 || !job.problem.empty()) continue;
        if (std::ranges::find(known, work->format) == known.end())
            job.problem = fmt::format("clips: synth makes no clips of format '{}'; it makes {}", work->format,
                                      fmt::join(known, ", "));
        else if (!work->actions.empty() && work->format != known[0])
            job.problem = fmt::format("actions: clips of format '{}' are of all its actions; leave it out",
                                      work->format);
    }
}

void SweepJobs::check_ingests(std::vector<Job>& jobs) {
    for (auto& job : jobs) {
        const auto* work = std::get_if<IngestWork>(&job.work);
        if (!work) continue;
        for (auto words : Commands{}(*work)) {
            std::ranges::replace(words, work->synthetic, ".");  // what is not made yet
            if (job.problem.empty())
                job.problem = problem_of(words, [](CLI::App& app) {
                    add_synth(app);
                    add_ingest(app);
                });
        }
    }
}

void SweepJobs::check_trainings(std::vector<Job>& jobs) {
    auto asked = nlohmann::json::array();
    std::vector<Job*> trainings;
    for (auto& job : jobs)
        if (const auto* work = std::get_if<TrainingWork>(&job.work); work && job.problem.empty()) {
            asked.push_back({{"network", work->network}, {"config", work->config}, {"set", work->set}});
            trainings.push_back(&job);
        }
    if (trainings.empty()) return;
    const Scratch folder("check");
    const auto file = (folder.path() / "trainings.json").string();
    write_whole(file, asked.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    const auto answer = output_of({(program_folder() / "actformer").string(), "train", "check", file});
    if (!answer) return;
    const auto problems = nlohmann::json::parse(*answer);
    for (std::size_t i = 0; i < trainings.size(); ++i)
        trainings[i]->problem = problems.at(i).get<std::string>();
}

}  // namespace actformer::cli
