#include "reports/sweep/split_check.hpp"

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "reports/sweep/configuration.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

/// The splits of datasets, each read once.
class SplitCheck {
  public:
    SplitCheck(const fs::path& file, const fs::path& out) : file_(file), out_(out) {}

    /// `key` of `who` asks for `split` of the dataset at `path`, which `job` needs.
    void check(const std::string& who, const char* key, const std::string& split, const Job& job,
               const std::string& path) {
        if (split.empty()) return;
        const auto& known = splits_at(filled_in(path, out_, job));
        if (known.empty() || std::ranges::find(known, split) != known.end()) return;
        throw Error("{}: {}: no split '{}' in its dataset, which has {}; set {}: to one of them",
                    file_.string(), who, split, fmt::join(known, ", "), key);
    }

    void check(const std::string& who, const Job& job) {
        const auto* work = std::get_if<TrainingWork>(&job.work);
        if (!work) return;
        for (const auto& [key, otherwise] : {std::pair{"train_split", "all"}, {"test_split", ""}})
            check(who, key, text_in(work->set, work->config, key, otherwise), job, work->data);
    }

  private:
    /// None where there is no dataset yet, or none that can be read.
    const std::vector<std::string>& splits_at(const std::string& path) {
        const auto [found, fresh] = splits_.try_emplace(path);
        if (!fresh || !fs::exists(path)) return found->second;
        try {
            const auto file = ingest::read_dataset_json(ingest::one_dataset_at(path) / "dataset.json");
            found->second = {"all"};
            for (const auto& split : file.header.splits) found->second.push_back(split.name);
        } catch (const Error&) {  // whoever uses it will say why
        }
        return found->second;
    }

    fs::path file_, out_;
    std::map<std::string, std::vector<std::string>> splits_;
};

}  // namespace

void check_splits(const fs::path& file, const Plan& plan, const fs::path& out) {
    SplitCheck splits(file, out);
    for (const auto& job : plan.jobs)
        if (job.kind == "recogniser") splits.check(job.title, job);
    for (const auto& planned : plan.rows) {
        const auto& run = planned.runs.front();
        const auto who = fmt::format("row '{}'", planned.row->name);
        if (run.generator) splits.check(who, plan.jobs[*run.generator]);
        splits.check(who, "split", planned.split, plan.jobs[run.score], run.dataset);
    }
}

}  // namespace actformer::reports
