#include "reports/page/curves.hpp"

#include <fstream>
#include <map>

namespace actformer::reports {

using Json = nlohmann::ordered_json;

nlohmann::ordered_json read_curves(const std::filesystem::path& run, const std::vector<std::string>& keys) {
    constexpr std::size_t most = 500;
    std::map<std::uint64_t, Json> epochs;
    std::ifstream log(run / "log.jsonl");
    for (std::string line; std::getline(log, line);) {
        const auto said = Json::parse(line, nullptr, false);
        if (!said.is_object() || !said.contains("epoch") || !said["epoch"].is_number_unsigned()) continue;
        auto& epoch = epochs[said["epoch"]];
        epoch["epoch"] = said["epoch"];
        for (const auto& key : keys)
            if (said.contains(key) && said[key].is_number()) epoch[key] = said[key];
    }
    Json out = Json::array();
    const auto stride = (epochs.size() + most - 1) / most;
    std::size_t place = 0;
    for (auto& [number, epoch] : epochs)
        if (++place == epochs.size() || (place - 1) % stride == 0) out.push_back(std::move(epoch));
    return out;
}

}  // namespace actformer::reports
