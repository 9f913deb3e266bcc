#include "reports/page/curves.hpp"

#include <algorithm>
#include <map>

#include "base/checksum/checked_lines.hpp"
#include "base/files/lock.hpp"
#include "eval/metrics/metric.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;

/// Where a key's numbers are drawn.
struct ChartOf {
    std::string title, unit, series;
    double scale = 1;
    bool from_zero = false;
};

/// What stands before the ending `name`: "train" of train_accuracy; none where it does not end so.
std::optional<std::string> before(const std::string& key, const std::string& name) {
    if (key == name) return "";
    const auto ending = "_" + name;
    if (!key.ends_with(ending)) return {};
    auto words = key.substr(0, key.size() - ending.size());
    std::ranges::replace(words, '_', ' ');
    return words;
}

std::optional<ChartOf> chart_of(const std::string& key) {
    if (const auto series = before(key, "loss")) return ChartOf{"loss", "", *series};
    if (const auto series = before(key, "score")) return ChartOf{"discriminator\u2019s score", "", *series};
    for (const auto& known : eval::metrics())
        if (const auto series = before(key, std::string(known.name)))
            return ChartOf{std::string(known.heading), std::string(known.unit), *series, known.scale, true};
    return {};
}

}  // namespace

bool has_log(const std::filesystem::path& run) {
    std::error_code unread;
    return std::filesystem::is_regular_file(run / "log.jsonl", unread);
}

Curves read_curves(const std::filesystem::path& run) {
    constexpr std::size_t most = 500;
    std::map<std::uint64_t, Json> epochs;
    Curves out;
    if (run.empty() || !has_log(run)) return out;
    const auto file = run / "log.jsonl";
    const auto lines = read_checked_lines(file);
    const bool goes_on = FileLock::is_held(run / "lock");
    if (!lines.damaged.empty() || !lines.missing.empty() || !goes_on) out.fault = lines.fault(file);
    for (const auto& said : lines.objects) {
        if (!said.contains("epoch") || !said["epoch"].is_number_unsigned()) continue;
        auto& epoch = epochs[said["epoch"]];
        for (const auto& [key, value] : said.items())
            if (value.is_number()) epoch[key] = value;
    }
    const auto stride = (epochs.size() + most - 1) / most;
    std::size_t place = 0;
    for (auto& [number, epoch] : epochs)
        if (++place == epochs.size() || (place - 1) % stride == 0) out.epochs.push_back(std::move(epoch));
    return out;
}

nlohmann::ordered_json curve_charts(const nlohmann::ordered_json& epochs, const std::string& whole) {
    Json points = Json::array(), charts = Json::array();
    std::map<std::string, std::size_t> known;  // charts by their titles
    std::map<std::string, std::optional<ChartOf>> keys;
    const auto add_series = [&](const std::string& key, const ChartOf& chart) {
        const auto [at, first] = known.try_emplace(chart.title, charts.size());
        if (first)
            charts.push_back({{"title", chart.title},
                              {"unit", chart.unit},
                              {"from_zero", chart.from_zero},
                              {"series", Json::array()}});
        charts[at->second]["series"].push_back(
            {{"key", key}, {"name", chart.series.empty() ? whole : chart.series}});
    };
    for (const auto& epoch : epochs) {
        Json point{{"epoch", epoch["epoch"]}};
        for (const auto& [key, value] : epoch.items()) {
            const auto [found, first] = keys.try_emplace(key);
            auto& chart = found->second;
            if (first && (chart = chart_of(key))) add_series(key, *chart);
            if (chart) point[key] = chart->scale * value.get<double>();
        }
        points.push_back(std::move(point));
    }
    return {{"points", points}, {"charts", charts}};
}

}  // namespace actformer::reports
