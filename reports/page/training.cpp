#include "reports/page/training.hpp"

#include <fmt/format.h>

#include "base/checksum/checked_text.hpp"
#include "base/files/lock.hpp"
#include "eval/recogniser_kind.hpp"
#include "reports/page/curves.hpp"
#include "reports/sweep/configuration.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

std::uint64_t last_epoch(const fs::path& folder) {
    const auto epochs = read_curves(folder).epochs;
    return epochs.empty() ? 0 : epochs.back()["epoch"].get<std::uint64_t>();
}

/// Of a training that nobody works on.
void tell_whether_done(const fs::path& folder, MeasuredRow& row) {
    const auto epochs = in_configuration(folder / "config.yaml", "epochs", std::uint64_t{0});
    const auto last = last_epoch(folder);
    row.status = last < epochs ? "stopped" : "done";
    if (last < epochs)
        row.why =
            fmt::format("after epoch {} of {}; the command that began it goes on from there", last, epochs);
}

}  // namespace

std::optional<MeasuredRow> training_row(const fs::path& folder) {
    const auto config = folder / "config.yaml";
    const bool goes_on = FileLock::is_held(folder / "lock");
    if (!(has_log(folder) || goes_on)) return {};
    if (std::error_code unread; fs::is_regular_file(config, unread)) expect_checksum_comment(config);
    const auto model = in_configuration(config, "model", std::string());
    if (model.empty()) return {};
    MeasuredRow row;
    const auto whole = fs::weakly_canonical(folder);
    row.name = whole.filename().string();
    row.status = "waiting";
    if (!goes_on) tell_whether_done(folder, row);
    MeasuredRun run;
    run.status = row.status;
    (eval::recogniser_kind_named(model) ? run.recogniser : run.run) = whole;
    row.runs.push_back(std::move(run));
    return row;
}

}  // namespace actformer::reports
