#include "ingest/synth/programmes/everyday.hpp"

#include <map>

#include "base/error.hpp"

namespace actformer::ingest::synth {

const Programme& everyday_programme(std::string_view name) {
    static const auto all = [] {
        std::map<std::string_view, Programme> out;
        for (const auto& table : {locomotion(), postures(), handling()})
            for (const auto& one : table) out.emplace(one.name, one.programme);
        return out;
    }();
    const auto found = all.find(name);
    if (found == all.end()) throw Error("no programme called '{}'", name);
    return found->second;
}

}  // namespace actformer::ingest::synth
