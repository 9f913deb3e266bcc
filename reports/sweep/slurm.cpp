// submit_plan and jobs_in_slurm of run.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/scratch.hpp"
#include "base/process/interruption.hpp"
#include "base/process/process.hpp"
#include "base/text/loose_json.hpp"
#include "base/text/printable.hpp"
#include "reports/sweep/kept.hpp"
#include "reports/sweep/run.hpp"
#include "reports/sweep/waiting_lock.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Slurm's numbers of the jobs that were submitted. Those of a damaged file, taken for none, would have the jobs submitted twice.
Json submitted_before(const fs::path& out) {
    const auto path = out / "slurm.json";
    if (!fs::exists(path)) return Json::object();
    auto json = loose::read(path);
    if (!json.is_object() || own_checksum_of(json) == OwnChecksum::wrong)
        throw Error("{}: damaged; remove it once none of the sweep's jobs waits or runs in Slurm",
                    path.string());
    json.erase("checksum");
    json.erase("program");
    return json;
}

/// Empty where it was never submitted.
std::string number_of(const std::string& id, const Json& numbers) {
    return numbers.contains(id) && numbers[id].is_string() ? numbers[id].get<std::string>() : std::string();
}

void keep_submitted(Json numbers, const fs::path& out) {
    numbers["program"] = "actformer " ACTFORMER_VERSION;
    write_whole(out / "slurm.json", with_checksum(std::move(numbers)).dump(2) + "\n");
}

/// Its last words, which begin with its name where they are its own.
std::string refusal(const std::string& program, const std::string& line) {
    if (line.starts_with(program + ":")) return line;
    return program + ": " + (line.empty() ? "failed" : line);
}

/// What waits or runs in Slurm.
struct Queue {
    std::set<std::string> numbers;            ///< of all jobs of this user
    std::map<std::string, std::string> ours;  ///< by id, of the jobs submitted from one folder
};

/// What a job submitted from `out` has as its comment, up to its id.
std::string comment_of_jobs(const fs::path& out) {
    return fs::absolute(out / "jobs").lexically_normal().string() + "/";
}

/// Takes what squeue prints of a job: its number, state, reason (which may have spaces) and comment, which may hold any bytes: JSON takes
/// text alone.
void take_line(const std::string& line, const std::string& own, Queue& queue) {
    std::istringstream words(line);
    std::string number, state, reason, comment;
    for (auto* word : {&number, &state, &reason}) std::getline(words, *word, '|');
    std::getline(words, comment);
    if (state == "CG" || reason == "DependencyNeverSatisfied") return;
    number = printable(number);
    queue.numbers.insert(number);
    if (comment.starts_with(own)) queue.ours[printable(comment.substr(own.size()))] = number;
}

/// What squeue tells; none where it does not answer. Left out are jobs that are over but for the tidying up, and those that wait for
/// what failed, which Slurm is about to drop.
std::optional<Queue> queue(const fs::path& out, const fs::path& log, std::string& why) {
    const auto said = answer_of({"squeue", "--noheader", "--me", "--format", "%i|%t|%r|%k"}, log);
    why = said.why;
    if (said.exit != 0) return {};
    const auto own = comment_of_jobs(out);
    Queue queue;
    std::istringstream lines(said.output);
    for (std::string line; std::getline(lines, line);) take_line(line, own, queue);
    return queue;
}

/// sbatch --parsable prints NUMBER or NUMBER;CLUSTER.
std::string number_in(const std::string& line) {
    const auto number = line.substr(0, line.find(';'));
    const bool digits = !number.empty() && std::all_of(number.begin(), number.end(),
                                                       [](unsigned char c) { return std::isdigit(c) != 0; });
    return digits ? number : std::string();
}

/// Gives the job to sbatch; its number there.
std::string submit(const Job& job, const std::string& after, const SweepOptions& options,
                   const std::vector<std::string>& command, const std::vector<std::string>& sbatch_words) {
    const auto folder = folder_of(options.out, job);
    const auto log = options.out / "slurm.log";
    make_folders(folder);
    std::vector<std::string> words{"sbatch",     "--parsable",
                                   "--job-name", job.id,
                                   "--output",   (folder / "slurm.txt").string(),
                                   "--comment",  comment_of_jobs(options.out) + job.id};
    if (!after.empty())
        words.insert(words.end(), {"--dependency", "afterok" + after, "--kill-on-invalid-dep=yes"});
    words.insert(words.end(), sbatch_words.begin(), sbatch_words.end());
    words.insert(words.end(), {"--wrap", command_line(command)});
    const auto said = answer_of(words, log, OnSignal::wait);
    std::string number, last;  // a site's own sbatch may print more
    std::istringstream lines(said.output);
    for (std::string line; std::getline(lines, line); last = line)
        if (const auto found = number_in(line); !found.empty()) number = found;
    if (said.exit != 0 || number.empty())
        throw Error("{}; see {}", refusal("sbatch", said.why.empty() ? last : said.why), log.string());
    return number;
}

}  // namespace

std::optional<std::set<std::string>> jobs_in_slurm(const fs::path& out) {
    if (!fs::exists(out / "slurm.json")) return {};
    const auto before = submitted_before(out);
    std::string why;
    const Scratch scratch("squeue");  // `out` may be another user's
    const auto now = queue(out, scratch.path() / "log", why);
    if (!now) return {};
    std::set<std::string> ids;
    for (const auto& [id, number] : before.items())
        if (number.is_string() && now->numbers.contains(number.get<std::string>())) ids.insert(id);
    for (const auto& [id, number] : now->ours) ids.insert(id);
    return ids;
}

std::size_t submit_plan(const Sweep& sweep, const Plan& plan, const SweepOptions& options,
                        const std::function<std::vector<std::string>(const Job&)>& command,
                        const std::vector<std::string>& sbatch_words,
                        const std::function<void(const Job& job, const std::string& why)>& again) {
    const SafePoints safe_points;  // between two jobs: the number of what is submitted is kept
    make_folders(options.out / "jobs");
    write_results(sweep, plan, options.out);
    const auto lock = lock_when_free(options.out / "lock", safe_points);
    if (!lock) safe_points.stop("another process submits the sweep's jobs");
    auto numbers = submitted_before(options.out);
    std::string why;
    const auto queued = queue(options.out, options.out / "slurm.log", why);
    if (!queued && safe_points.asked()) safe_points.stop("nothing submitted");
    if (!queued) throw Error("{}", refusal("squeue", why));
    for (const auto& [id, number] : queued->ours)
        if (!queued->numbers.contains(number_of(id, numbers)))
            numbers[id] = number;  // a kill came before it was kept
    keep_submitted(numbers, options.out);
    // Asked after the queue: what has left that has left its mark by now.
    const auto status = checked_statuses(plan, options.out, again);
    std::vector<std::string> live(plan.jobs.size());  // numbers of those that wait or run
    std::vector<bool> fresh(plan.jobs.size());
    std::size_t submitted = 0;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        const auto& job = plan.jobs[i];
        if (status[i].state == JobState::done || !job.problem.empty()) continue;
        bool possible = true;
        bool stale = false;  // queued after what ended without being done: Slurm is about to drop it
        std::string after;
        for (const auto need : job.needs) {
            if (status[need].state == JobState::done) continue;
            possible = possible && !live[need].empty();
            stale = stale || fresh[need];
            after += ":" + live[need];
        }
        if (!possible) continue;  // it needs what has a problem
        live[i] = number_of(job.id, numbers);
        if (!live[i].empty() && queued->numbers.contains(live[i]) && !stale) continue;
        if (safe_points.asked())
            safe_points.stop(fmt::format("{} submitted, and the same command goes on from there", submitted));
        try {
            live[i] = submit(job, after, options, command(job), sbatch_words);
        } catch (const Error&) {
            if (safe_points.asked()) safe_points.stop(fmt::format("{} submitted", submitted));
            throw;
        }
        fresh[i] = true;
        numbers[job.id] = live[i];
        keep_submitted(numbers, options.out);
        ++submitted;
    }
    return submitted;
}

}  // namespace actformer::reports
