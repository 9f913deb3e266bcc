#include "base/pickle/pickle.hpp"

#include "base/error.hpp"
#include "base/pickle/machine.hpp"
#include "base/pickle/node.hpp"
#include "base/pickle/unpack.hpp"
#include "base/text/html.hpp"

namespace actformer {

Pickle::Pickle(std::string_view text, const PickleLimits& limits, const Passed& passed)
    : store_(std::make_unique<PickleStore>()) {
    if (text.empty()) throw Error("the file is empty");
    if (is_html(text)) throw Error("{}", html_in_place_of("a pickle"));
    if (auto inside = unpacked(text, limits.unpacked)) {
        store_->unpacked = std::move(*inside);
        run(store_->unpacked, limits, {});
    } else {
        run(text, limits, passed);
    }
}

void Pickle::run(std::string_view text, const PickleLimits& limits, const Passed& passed) {
    PickleMachine machine(text, limits, *store_);
    root_ = machine.run(passed);
    size_ = machine.taken();
}

std::vector<PickleValue> Pickle::references() const {
    std::vector<PickleValue> out;
    for (const auto& node : store_->nodes)
        if (node.kind == PickleNode::Kind::reference) out.emplace_back(&node, node.items.front().at());
    return out;
}

Pickle::~Pickle() = default;
Pickle::Pickle(Pickle&&) noexcept = default;
Pickle& Pickle::operator=(Pickle&&) noexcept = default;

}  // namespace actformer
