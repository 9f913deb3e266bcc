#include "base/pickle/value.hpp"

#include <vector>

#include "base/error.hpp"
#include "base/pickle/node.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

using Kind = PickleNode::Kind;

std::string utf8_of_latin1(std::string_view bytes) {
    std::string out;
    out.reserve(bytes.size());
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x80) out += static_cast<char>(0xC0 | byte >> 6);
        out += static_cast<char>(byte < 0x80 ? byte : 0x80 | (byte & 0x3F));
    }
    return out;
}

std::string what_node(const PickleNode& node) {
    switch (node.kind) {
        case Kind::tuple:
            return "a tuple";
        case Kind::list:
            return "a list";
        case Kind::set:
            return "a set";
        case Kind::dict:
            return "a dict";
        case Kind::object:
            return fmt::format("a {} {}", node.of->module, node.of->name);
        case Kind::array:
            return fmt::format("an array of {} {}", node.array->type, node.array->shape_text());
        case Kind::unfilled:
            return "an array without numbers";
        case Kind::type:
            return "a NumPy type";
        case Kind::call:
            return fmt::format("a call of {} {}", node.of->module, node.of->name);
        case Kind::reference:
            return "a value that lies elsewhere";
    }
    return {};
}

/// "chumpy.ch Ch"
bool is_called(const PickleGlobal& global, std::string_view called) {
    const auto module = global.module;
    return called.size() == module.size() + 1 + global.name.size() && called.starts_with(module) &&
           called[module.size()] == ' ' && called.ends_with(global.name);
}

}  // namespace

const PickleNode* PickleValue::node() const {
    const auto* held = std::get_if<const PickleNode*>(&held_);
    return held ? *held : nullptr;
}

std::string PickleValue::what() const {
    if (const auto* n = node()) return what_node(*n);
    if (is_none()) return "None";
    if (const auto* truth = std::get_if<bool>(&held_)) return *truth ? "True" : "False";
    if (const auto* whole = std::get_if<std::int64_t>(&held_)) return fmt::format("the number {}", *whole);
    if (const auto* real = std::get_if<double>(&held_)) return fmt::format("the number {}", *real);
    if (is_text()) return "the text " + in_quotes(bytes());
    const auto* global = std::get<const PickleGlobal*>(held_);
    return fmt::format("the name {} {}", global->module, global->name);
}

void PickleValue::not_a(std::string_view wanted) const {
    throw Error("byte {}: {}, not {}", at_, what(), wanted);
}

bool PickleValue::is_sequence() const {
    const auto* n = node();
    return n &&
           (n->kind == Kind::list || n->kind == Kind::tuple || n->kind == Kind::set || n->kind == Kind::call);
}

bool PickleValue::is_dict() const {
    const auto* n = node();
    return n && n->kind == Kind::dict;
}

bool PickleValue::is_array() const {
    const auto* n = node();
    return n && n->kind == Kind::array;
}

bool PickleValue::is_object(std::string_view called) const {
    const auto* n = node();
    return n && n->kind == Kind::object && is_called(*n->of, called);
}

bool PickleValue::is_call(std::string_view called) const {
    const auto* n = node();
    return n && n->kind == Kind::call && is_called(*n->of, called);
}

std::optional<PickleValue> PickleValue::reference() const {
    const auto* n = node();
    if (!n || n->kind != Kind::reference) return {};
    return n->items[0];
}

bool PickleValue::truth() const {
    if (const auto* truth = std::get_if<bool>(&held_)) return *truth;
    if (const auto* whole = std::get_if<std::int64_t>(&held_); whole && (*whole == 0 || *whole == 1))
        return *whole == 1;  // as old pickles write it
    not_a("True or False");
}

std::int64_t PickleValue::whole() const {
    if (const auto* whole = std::get_if<std::int64_t>(&held_)) return *whole;
    not_a("a whole number");
}

double PickleValue::real() const {
    if (const auto* real = std::get_if<double>(&held_)) return *real;
    if (const auto* whole = std::get_if<std::int64_t>(&held_)) return static_cast<double>(*whole);
    not_a("a number");
}

std::string_view PickleValue::bytes() const {
    if (const auto* text = std::get_if<Text>(&held_)) return text->utf8;
    if (const auto* bytes = std::get_if<Bytes>(&held_)) return bytes->bytes;
    not_a("a text");
}

std::string PickleValue::text() const {
    return std::holds_alternative<Bytes>(held_) ? utf8_of_latin1(bytes()) : std::string(bytes());
}

const NumpyArray& PickleValue::array() const {
    if (!is_array()) not_a("an array");
    return *node()->array;
}

std::size_t PickleValue::size() const {
    if (is_dict()) return node()->items.size() / 2;
    if (!is_sequence()) not_a("a list");
    return node()->items.size();
}

PickleValue PickleValue::operator[](std::size_t i) const {
    if (!is_sequence()) not_a("a list");
    const auto& items = node()->items;
    if (i >= items.size())
        throw Error("byte {}: {} of {}; there is no element {}", at_, what(), items.size(), i);
    return items[i];
}

/// Its own items, or those of an object's attributes.
const PickleNode& PickleValue::dict() const {
    const auto* n = node();
    if (n && n->kind == Kind::object && !n->items.empty()) return n->items[0].dict();
    if (!is_dict()) not_a("a dict");
    return *n;
}

std::pair<PickleValue, PickleValue> PickleValue::entry(std::size_t i) const {
    const auto& items = dict().items;
    if (2 * i + 1 >= items.size()) throw Error("byte {}: {} has no entry {}", at_, what(), i);
    return {items[2 * i], items[2 * i + 1]};
}

/// From the end: a key that was set twice has its last value.
template <typename Is>
std::optional<PickleValue> PickleValue::find_if(Is is) const {
    const auto& items = dict().items;
    for (auto i = items.size(); i >= 2; i -= 2)
        if (is(items[i - 2])) return items[i - 1];
    return {};
}

std::optional<PickleValue> PickleValue::find(std::string_view key) const {
    return find_if([&](const PickleValue& k) { return k.is_text() && k.bytes() == key; });
}

std::optional<PickleValue> PickleValue::find(std::int64_t key) const {
    return find_if([&](const PickleValue& k) {
        const auto* whole = std::get_if<std::int64_t>(&k.held_);
        return whole && *whole == key;
    });
}

PickleValue PickleValue::get(std::string_view key) const {
    if (auto found = find(key)) return *found;
    constexpr std::size_t most_named = 20;
    std::vector<std::string> keys;
    const auto& items = dict().items;
    for (std::size_t i = 0; i < items.size() && keys.size() < most_named; i += 2)
        keys.push_back(items[i].is_text() ? in_quotes(items[i].bytes()) : items[i].what());
    throw Error("byte {}: {} without {}; it has {}", at_, what(), in_quotes(key),
                keys.empty() ? "nothing" : fmt::format("{}", fmt::join(keys, ", ")));
}

}  // namespace actformer
