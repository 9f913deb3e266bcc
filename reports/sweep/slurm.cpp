// submit_plan of run.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "ingest/file.hpp"
#include "kernels/error.hpp"
#include "reports/sweep/process.hpp"
#include "reports/sweep/run.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json submitted_before(const fs::path& out) {
    std::ifstream file(out / "slurm.json");
    auto json = Json::parse(file, nullptr, false);
    return json.is_object() ? json : Json::object();
}

/// Slurm's number of a job that still waits or runs there; empty where it does not.
std::string queued(const Json& before, const Job& job, const fs::path& log) {
    if (!before.contains(job.id) || !before[job.id].is_string()) return {};
    const auto number = before[job.id].get<std::string>();
    const auto asked = run_process({"squeue", "--noheader", "--jobs", number, "--format", "%i"}, log);
    return asked.exit == 0 && asked.last_line.find(number) != std::string::npos ? number : std::string();
}

/// sbatch --parsable prints NUMBER or NUMBER;CLUSTER.
std::string number_in(const std::string& line) {
    const auto number = line.substr(0, line.find(';'));
    const bool digits = !number.empty() && std::all_of(number.begin(), number.end(),
                                                       [](unsigned char c) { return std::isdigit(c) != 0; });
    return digits ? number : std::string();
}

}  // namespace

std::size_t submit_plan(const Sweep& sweep, const Plan& plan, const SweepOptions& options,
                        const std::vector<std::string>& again, const std::vector<std::string>& sbatch_words) {
    fs::create_directories(options.out / "jobs");
    write_results(sweep, plan, options.out);
    const auto log = options.out / "slurm.log";
    const auto status = statuses(plan, options.out);
    const auto before = submitted_before(options.out);
    auto numbers = before;
    std::size_t submitted = 0;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        const auto& job = plan.jobs[i];
        if (status[i].state == JobState::done || !job.problem.empty()) continue;
        bool possible = true;
        std::string after;
        for (const auto need : job.needs) {
            if (status[need].state == JobState::done) continue;
            possible = possible && plan.jobs[need].problem.empty() && numbers.contains(plan.jobs[need].id);
            if (possible) after += ":" + numbers[plan.jobs[need].id].get<std::string>();
        }
        if (!possible) continue;  // it needs what has a problem
        if (!queued(before, job, log).empty()) continue;
        fs::create_directories(folder_of(options.out, job));
        auto only = again;
        only.insert(only.end(), {"--only", job.id});
        std::vector<std::string> words{"sbatch",     "--parsable",
                                       "--job-name", job.id,
                                       "--output",   (folder_of(options.out, job) / "slurm.txt").string()};
        if (!after.empty())
            words.insert(words.end(), {"--dependency", "afterok" + after, "--kill-on-invalid-dep=yes"});
        words.insert(words.end(), sbatch_words.begin(), sbatch_words.end());
        words.insert(words.end(), {"--wrap", command_line(only)});
        const auto said = run_process(words, log);
        const auto number = number_in(said.last_line);
        if (said.exit != 0 || number.empty())
            throw Error("sbatch: {}; see {}", said.last_line.empty() ? "failed" : said.last_line,
                        log.string());
        numbers[job.id] = number;
        ingest::write_whole(options.out / "slurm.json", numbers.dump(2) + "\n");
        ++submitted;
    }
    return submitted;
}

}  // namespace actformer::reports
