#include "reports/page/training.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>

#include "base/files/lock.hpp"
#include "reports/page/curves.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

/// What a training's configuration says of a key, in a line "key: value  # what it means"; empty where it is none.
std::string said(const fs::path& config, const std::string& key) {
    std::error_code unread;
    if (!fs::is_regular_file(config, unread)) return {};
    std::ifstream file(config);
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(key + ": ")) {
            const auto value = line.substr(key.size() + 2);
            return value.substr(0, value.find_first_of(" #"));
        }
    return {};
}

std::uint64_t last_epoch(const fs::path& folder) {
    const auto epochs = read_curves(folder);
    return epochs.empty() ? 0 : epochs.back()["epoch"].get<std::uint64_t>();
}

/// Of a training that nobody works on.
void tell_whether_done(const fs::path& folder, MeasuredRow& row) {
    const auto words = said(folder / "config.yaml", "epochs");
    std::uint64_t epochs = 0;
    std::from_chars(words.data(), words.data() + words.size(), epochs);
    const auto last = last_epoch(folder);
    row.status = last < epochs ? "stopped" : "done";
    if (last < epochs)
        row.why =
            fmt::format("after epoch {} of {}; the command that began it goes on from there", last, epochs);
}

}  // namespace

std::optional<MeasuredRow> training_row(const fs::path& folder) {
    const auto model = said(folder / "config.yaml", "model");
    const bool goes_on = FileLock::is_held(folder / "lock");
    if (model.empty() || !(has_log(folder) || goes_on)) return {};
    MeasuredRow row;
    const auto whole = fs::weakly_canonical(folder);
    row.name = whole.filename().string();
    row.status = "waiting";
    if (!goes_on) tell_whether_done(folder, row);
    MeasuredRun run;
    run.status = row.status;
    (model == "recogniser" || model == "gru" ? run.recogniser : run.run) = whole;
    row.runs.push_back(std::move(run));
    return row;
}

}  // namespace actformer::reports
