#include "ingest/dataset/representation.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace actformer::ingest {
namespace {

struct Row {
    const char* name;
    std::uint32_t numbers;
    Finish finish;
};

/// In the order of Representation::Kind.
constexpr std::array<Row, 3> table{
    {{"limb", 3, Finish::unit}, {"rot6d", 6, Finish::orthonormal}, {"xyz", 3, Finish::linear}}};

}  // namespace

const std::vector<Representation>& Representation::all() {
    static const std::vector<Representation> every{limb, rot6d, xyz};
    return every;
}

Representation Representation::named(const std::string& name, const std::string& where) {
    std::string known;
    for (const auto one : all()) {
        if (one.name() == name) return one;
        known += (known.empty() ? "" : ", ") + one.name();
    }
    throw Error("{}: representation '{}' is none of {}", where, name, known);
}

std::string Representation::name() const {
    return table[kind_].name;
}

std::uint32_t Representation::numbers() const {
    return table[kind_].numbers;
}

Finish Representation::finish() const {
    return table[kind_].finish;
}

std::vector<int> Representation::node_parents(const Topology& topology) const {
    auto parents = topology.parents;
    if (kind_ == rot6d)
        parents.push_back(static_cast<int>(std::find(parents.begin(), parents.end(), -1) - parents.begin()));
    return parents;
}

std::uint32_t Representation::nodes(const Topology& topology) const {
    return static_cast<std::uint32_t>(topology.joints() + (kind_ == rot6d ? 1 : 0));
}

std::optional<std::uint32_t> Representation::free_node(std::uint32_t nodes) const {
    switch (kind_) {
        case limb:
            return 0;
        case rot6d:
            return nodes - 1;
        case xyz:
            break;
    }
    return std::nullopt;
}

Representation::Moving Representation::moving(std::uint32_t nodes) const {
    switch (kind_) {
        case limb:
            break;
        case rot6d:
            return {nodes - 1, nodes - 1, 1};
        case xyz:
            return {0, 0, nodes};
    }
    return {};
}

}  // namespace actformer::ingest
