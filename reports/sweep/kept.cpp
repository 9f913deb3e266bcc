#include "reports/sweep/kept.hpp"

#include <fmt/format.h>

#include <map>

#include "base/checksum/checked_json.hpp"
#include "base/checksum/checksum.hpp"
#include "base/text/loose_json.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_result(const fs::path& file) {
    const auto name = file.filename().string();
    if (name == "scores.json" || name == "dataset.json" || name == "config.yaml") return true;
    return name.ends_with(".h5") && !name.starts_with("shard-") && !name.starts_with("checkpoint-");
}

}  // namespace

Json checksums_of_results(const fs::path& folder) {
    std::map<std::string, std::string> found;
    for (fs::recursive_directory_iterator it(folder), end; it != end; ++it) {
        if (it->is_directory() && it->path().filename() == "raw") it.disable_recursion_pending();
        if (it->is_regular_file() && is_result(it->path()))
            found[it->path().lexically_relative(folder).string()] = checksum_file(it->path());
    }
    return found;
}

std::string fault_of_results(const fs::path& folder) {
    const auto path = folder / "done.json";
    const auto done = loose::read(path);
    const auto said = own_checksum_of(done);
    const auto& made = loose::member(done, "made");
    const bool lost = said == OwnChecksum::absent && made.is_object();  // those of old tell nothing made
    if (!done.is_object() || said == OwnChecksum::wrong || lost)
        return fmt::format("{}: damaged", path.string());
    if (!made.is_object()) return {};
    for (const auto& [name, sum] : made.items()) {
        std::error_code missing;
        if (!fs::is_regular_file(folder / name, missing))
            return fmt::format("{}: missing", (folder / name).string());
        if (!sum.is_string() || checksum_file(folder / name) != sum.get_ref<const std::string&>())
            return fmt::format("{}: changed since it was made", (folder / name).string());
    }
    return {};
}

std::vector<JobStatus> checked_statuses(const Plan& plan, const fs::path& out,
                                        const std::function<void(const Job&, const std::string& why)>& say) {
    auto all = statuses(plan, out);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].state != JobState::done) continue;
        const auto fault = fault_of_results(folder_of(out, plan.jobs[i]));
        if (fault.empty()) continue;
        all[i] = {};
        if (say) say(plan.jobs[i], fault);
    }
    return all;
}

void discard_results(const fs::path& folder) {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename() != "lock") all.push_back(entry.path());
    for (const auto& path : all) fs::remove_all(path);
}

}  // namespace actformer::reports
