#include "reports/page/training.hpp"

#include <fstream>

#include "base/files/lock.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

/// What the line "model: ..." of a configuration says.
std::string model_of(const fs::path& config) {
    const std::string key = "model: ";
    std::ifstream file(config);
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(key))
            return line.substr(key.size(), line.find_first_of(" #", key.size()) - key.size());
    return {};
}

}  // namespace

std::optional<MeasuredRow> training_row(const fs::path& folder) {
    const auto model = model_of(folder / "config.yaml");
    if (model.empty() || !fs::is_regular_file(folder / "log.jsonl")) return {};
    MeasuredRun run;
    (model == "recogniser" || model == "gru" ? run.recogniser : run.run) = fs::absolute(folder);
    MeasuredRow row;
    row.name = (folder.has_filename() ? folder : folder.parent_path()).filename().string();
    row.status = run.status = FileLock::is_held(folder / "lock") ? "waiting" : "done";
    row.runs.push_back(std::move(run));
    return row;
}

}  // namespace actformer::reports
