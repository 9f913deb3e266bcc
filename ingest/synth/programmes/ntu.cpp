#include "ingest/synth/programmes/ntu.hpp"

#include <algorithm>

#include "ingest/formats/ntu/actions.hpp"

namespace actformer::ingest::synth {

const Programme& programme_of(int action) {
    static const auto all = [] {
        std::vector<Programme> sorted;
        for (const auto& table : {daily_programmes(), further_programmes(), together_programmes()})
            sorted.insert(sorted.end(), table.begin(), table.end());
        std::sort(sorted.begin(), sorted.end(), [](auto& a, auto& b) { return a.action < b.action; });
        return sorted;
    }();
    ntu::action_name(action);  // refuses what is no action
    return all.at(static_cast<std::size_t>(action - 1));
}

}  // namespace actformer::ingest::synth
