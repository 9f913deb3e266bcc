#include "base/pickle/maker.hpp"

#include <algorithm>
#include <cmath>

#include "base/text/printable.hpp"

namespace actformer {
namespace {

using Kind = PickleNode::Kind;
using Makes = PickleGlobal::Makes;
using Text = PickleValue::Text;
using Bytes = PickleValue::Bytes;

constexpr std::uint64_t overhead = 16;  // of an allocation

const PickleNode* node_of(const PickleValue& value) {
    const auto* held = std::get_if<const PickleNode*>(&value.held());
    return held ? *held : nullptr;
}

const PickleGlobal* global_of(const PickleValue& value) {
    const auto* held = std::get_if<const PickleGlobal*>(&value.held());
    return held ? *held : nullptr;
}

bool makes(const PickleValue& value, Makes what) {
    const auto* global = global_of(value);
    return global && global->makes == what;
}

bool is_torch(const PickleGlobal& global) {
    return global.makes == Makes::storage || global.makes == Makes::tensor || global.makes == Makes::size;
}

bool is_latin1(std::string_view encoding) {
    return encoding == "latin1" || encoding == "latin-1";
}

}  // namespace

PickleMaker::PickleMaker(PickleText& text, const PickleLimits& limits, PickleStore& store)
    : text_(text), limits_(limits), store_(store), most_array_bytes_(text.left()) {}

void PickleMaker::fail(std::string_view what) const {
    throw Error("byte {}: {}", text_.opcode_at(), what);
}

void PickleMaker::charge(std::uint64_t bytes) {
    memory_ += bytes;
    if (bytes > limits_.memory || memory_ > limits_.memory)
        fail(fmt::format("its values take more than {} MiB, arrays apart: made to exhaust memory",
                         limits_.memory >> 20));
}

PickleNode& PickleMaker::node(Kind kind, std::vector<PickleValue> items) {
    charge(sizeof(PickleNode) + overhead + items.size() * sizeof(PickleValue));
    auto& node = store_.nodes.emplace_back();
    node.kind = kind;
    for (const auto& item : items) note_depth(node, item);
    node.items = std::move(items);
    return node;
}

void PickleMaker::note_depth(PickleNode& outer, const PickleValue& inner) const {
    if (const auto* node = node_of(inner)) outer.depth = std::max(outer.depth, node->depth + 1);
    if (outer.depth > limits_.nesting) fail("values nested too deep");
}

/// All nodes lie in the store, which is the maker's to change.
PickleNode& PickleMaker::mutable_node(const PickleValue& value) const {
    const auto* node = node_of(value);
    if (!node) fail(fmt::format("{} has no state and no elements", value.what()));
    return const_cast<PickleNode&>(*node);
}

void PickleMaker::add(const PickleValue& container, Kind kind, Arguments items) {
    auto& node = mutable_node(container);
    if (node.kind != kind) fail(fmt::format("{} takes no such elements", container.what()));
    if (kind == Kind::dict && items.size() % 2 != 0) fail("a key without a value");
    charge(2 * items.size() * sizeof(PickleValue));  // vectors grow by doubling
    for (const auto& item : items) note_depth(node, item);
    node.items.insert(node.items.end(), items.begin(), items.end());
}

std::string_view PickleMaker::spelled(std::string_view line, std::string (*decode)(std::string_view)) {
    charge(2 * line.size() + sizeof(std::string));
    try {
        return store_.texts.emplace_back(decode(line));
    } catch (const Error& e) {
        fail(e.what());
    }
}

std::string_view PickleMaker::text(const PickleValue& value) const {
    if (!value.is_text()) fail(fmt::format("{}, not a text", value.what()));
    return value.bytes();
}

PickleValue PickleMaker::global(std::string_view module, std::string_view name) const {
    if (const auto* known = pickle_global(module, name); known && (limits_.tensors || !is_torch(*known)))
        return value(known);
    throw Error(
        "{} {} at byte {} is none of the names that a file of numbers needs: it is refused, and nothing was "
        "run",
        printable(module.substr(0, 80)), printable(name.substr(0, 80)), text_.opcode_at());
}

PickleMaker::Arguments PickleMaker::items(const PickleValue& tuple) const {
    const auto* node = node_of(tuple);
    if (!node || (node->kind != Kind::tuple && node->kind != Kind::list))
        fail(fmt::format("{}, not a tuple", tuple.what()));
    return node->items;
}

PickleValue PickleMaker::call(const PickleValue& called, const PickleValue& arguments) {
    return call(called, items(arguments));
}

PickleValue PickleMaker::call(const PickleValue& called, Arguments arguments) {
    const auto* global = global_of(called);
    if (!global) fail(fmt::format("{} cannot be called", called.what()));
    switch (global->makes) {
        case Makes::array:
            return array(arguments);
        case Makes::type:
            return type(arguments);
        case Makes::scalar:
            return scalar(arguments);
        case Makes::from_buffer:
            return from_buffer(arguments);
        case Makes::bytes:
            return bytes(arguments);
        case Makes::list:
            return container(Kind::list, arguments);
        case Makes::tuple:
            return container(Kind::tuple, arguments);
        case Makes::set:
            return container(Kind::set, arguments);
        case Makes::dict:
            return dict(arguments);
        case Makes::instance:
            return instance(arguments);
        case Makes::object:
        case Makes::joblib_array:
            return object(*global);
        case Makes::in_other_file:
            fail("an array in another file, as joblib below 0.10 writes it; load it there and dump it anew");
        case Makes::size:
            return container(Kind::tuple, arguments);
        case Makes::tensor:
            return kept_call(*global, arguments);
        case Makes::array_class:
        case Makes::storage:
            break;
    }
    fail(fmt::format("{} {} is not called so by any writer", global->module, global->name));
}

/// numpy.dtype('f8', False, True)
PickleValue PickleMaker::type(Arguments arguments) {
    if (arguments.empty()) fail("a NumPy type without its name");
    const auto name = text(arguments[0]);
    auto array = std::make_unique<NumpyArray>();
    const bool spelled = name.find_first_of("<>|=") == 0;
    if (!array->take_type(spelled ? std::string(name) : "|" + std::string(name)))
        fail(fmt::format("{} is no NumPy type", in_quotes(name)));
    charge(sizeof(NumpyArray) + overhead + name.size());
    auto& made = node(Kind::type);
    made.array = std::move(array);
    return value(made);
}

/// (3, '<', subtype, names, fields, ...)
void PickleMaker::fill_type(PickleNode& type, const PickleValue& state) const {
    const auto parts = items(state);
    if (parts.size() < 5) fail("a NumPy type without its state");
    const auto order = text(parts[1]);
    if (!parts[2].is_none() || !parts[3].is_none())
        fail("a structured NumPy type; save an array of numbers for each of its fields");
    const auto spelled = std::string(order) + type.array->type.substr(1);
    if (!type.array->take_type(spelled)) fail(fmt::format("{} is no NumPy type", in_quotes(spelled)));
}

/// _reconstruct(ndarray, (0,), b'b'), whose state follows.
PickleValue PickleMaker::array(Arguments arguments) {
    if (arguments.empty() || !makes(arguments[0], Makes::array_class)) fail("an array of a class of its own");
    charge(sizeof(NumpyArray) + overhead);
    return value(node(Kind::unfilled));
}

void PickleMaker::set_type(NumpyArray& array, const PickleValue& type) const {
    const auto* node = node_of(type);
    if (!node || node->kind != Kind::type) fail(fmt::format("{}, not a NumPy type", type.what()));
    if (node->array->type.find('O') != std::string::npos)
        fail("an array of Python objects, which only running code could read; save arrays of numbers");
    if (node->array->kind == NumpyArray::Kind::other)
        fail(fmt::format("an array of type {}, which holds no numbers", in_quotes(node->array->type)));
    array = *node->array;
}

void PickleMaker::set_shape(NumpyArray& array, const PickleValue& shape) const {
    const auto axes = items(shape);
    constexpr std::size_t most_axes = 64;  // as NumPy has it
    if (axes.size() > most_axes) fail("an array of more than 64 axes");
    array.shape.clear();
    for (const auto& axis : axes) {
        const auto* length = std::get_if<std::int64_t>(&axis.held());
        if (!length || *length < 0) fail(fmt::format("{} is no length of an axis", axis.what()));
        array.shape.push_back(static_cast<std::uint64_t>(*length));
    }
}

/// Bytes of an array, which must lie in the file, as those of all arrays together must.
std::uint64_t PickleMaker::size_of(const NumpyArray& array) {
    charge(array.shape.size() * sizeof(std::uint64_t));
    const auto bytes = array.bytes();
    if (!bytes || *bytes > most_array_bytes_)
        fail(fmt::format("an array of {} {}, which the whole file cannot hold", array.type,
                         array.shape_text()));
    array_bytes_ += *bytes;
    if (array_bytes_ > most_array_bytes_)
        fail("arrays of more bytes than the file has: made to exhaust its readers");
    return *bytes;
}

/// (1, shape, type, in Fortran's order, bytes); the version in front is missing in the oldest.
void PickleMaker::fill_array(PickleNode& array, const PickleValue& state) {
    auto parts = items(state);
    if (parts.size() == 5) parts = parts.subspan(1);
    if (parts.size() != 4) fail("an array without its state");
    auto made = std::make_unique<NumpyArray>();
    set_type(*made, parts[1]);
    set_shape(*made, parts[0]);
    made->fortran_order = parts[2].truth();
    const auto bytes = text(parts[3]);
    if (size_of(*made) != bytes.size())
        fail(fmt::format("an array of {} {} in {} bytes", made->type, made->shape_text(), bytes.size()));
    made->values = bytes;
    array.array = std::move(made);
    array.kind = Kind::array;
}

/// _frombuffer(bytes, type, shape, 'C')
PickleValue PickleMaker::from_buffer(Arguments arguments) {
    if (arguments.size() != 4) fail("an array over bytes without its shape");
    auto made = std::make_unique<NumpyArray>();
    set_type(*made, arguments[1]);
    set_shape(*made, arguments[2]);
    made->fortran_order = text(arguments[3]) == "F";
    const auto bytes = text(arguments[0]);
    if (size_of(*made) != bytes.size())
        fail(fmt::format("an array of {} {} in {} bytes", made->type, made->shape_text(), bytes.size()));
    made->values = bytes;
    charge(sizeof(NumpyArray) + overhead);
    auto& array = node(Kind::array);
    array.array = std::move(made);
    return value(array);
}

/// What joblib writes for an array: a description, and behind it in the file padding and the numbers.
void PickleMaker::fill_from_file(PickleNode& object, const PickleValue& state) {
    if (!makes(state.get("subclass"), Makes::array_class)) fail("an array of a class of its own");
    auto made = std::make_unique<NumpyArray>();
    set_type(*made, state.get("dtype"));
    set_shape(*made, state.get("shape"));
    made->fortran_order = text(state.get("order")) == "F";
    if (const auto alignment = state.find("numpy_array_alignment_bytes"); alignment && !alignment->is_none())
        text_.take(text_.number<std::uint8_t>());
    const auto bytes = size_of(*made);
    if (bytes > text_.left())
        fail(fmt::format("{} bytes of an array of {} {} are to follow, and the file has {} more: cut short",
                         bytes, made->type, made->shape_text(), text_.left()));
    made->values = text_.take(bytes);
    charge(sizeof(NumpyArray) + overhead);
    object.array = std::move(made);
    object.kind = Kind::array;
}

/// multiarray.scalar(type, bytes)
PickleValue PickleMaker::scalar(Arguments arguments) {
    if (arguments.size() != 2) fail("a number without its bytes");
    NumpyArray one;
    set_type(one, arguments[0]);
    one.values = text(arguments[1]);
    if (one.values.size() != one.size)
        fail(fmt::format("a number of type {} in {} bytes", one.type, one.values.size()));
    if (!one.numbers()) {
        charge(sizeof(std::string) + 2 * one.size);
        return value(Text{store_.texts.emplace_back(one.all_texts()[0])});
    }
    const auto number = one.all_numbers()[0];
    if (one.type[1] == 'b') return value(number != 0);
    if (one.kind == NumpyArray::Kind::real) return value(number);
    constexpr double exact = 9007199254740992;  // whole numbers beyond may have been rounded
    if (std::abs(number) > exact) fail("a whole number of more than 53 bits");
    return value(static_cast<std::int64_t>(number));
}

/// Bytes of bytes, or of a text and its encoding, in which old protocols have them.
PickleValue PickleMaker::bytes(Arguments arguments) {
    if (arguments.empty()) return value(Bytes{});
    const auto given = text(arguments[0]);
    if (!std::holds_alternative<Text>(arguments[0].held())) return value(Bytes{given});
    if (arguments.size() < 2 || !is_latin1(text(arguments[1])))
        fail("bytes in an encoding other than latin-1");
    return value(Bytes{spelled(given, latin1_of)});
}

/// list(values), tuple(values), set(values)
PickleValue PickleMaker::container(Kind kind, Arguments arguments) {
    if (arguments.size() > 1) fail("a list of several lists");
    const auto values = arguments.empty() ? Arguments() : items(arguments[0]);
    return value(node(kind, {values.begin(), values.end()}));
}

/// OrderedDict([(key, value), ...]), or empty.
PickleValue PickleMaker::dict(Arguments arguments) {
    const auto made = value(node(Kind::dict));
    if (arguments.empty()) return made;
    for (const auto& pair : items(arguments[0])) {
        const auto both = items(pair);
        if (both.size() != 2) fail("a key without a value");
        add(made, Kind::dict, both);
    }
    return made;
}

/// _reconstructor(class, object, None)
PickleValue PickleMaker::instance(Arguments arguments) {
    const bool plain = arguments.size() == 3 && makes(arguments[1], Makes::object) && arguments[2].is_none();
    if (!plain) fail("an instance that begins as something else than an object");
    return call(arguments[0], Arguments());
}

PickleValue PickleMaker::object(const PickleGlobal& of) {
    auto& made = node(Kind::object);
    made.of = &of;
    return value(made);
}

PickleValue PickleMaker::kept_call(const PickleGlobal& of, Arguments arguments) {
    auto& made = node(Kind::call, {arguments.begin(), arguments.end()});
    made.of = &of;
    return value(made);
}

/// Attributes, or (attributes, slots).
void PickleMaker::fill_object(PickleNode& object, const PickleValue& state) const {
    const auto* given = node_of(state);
    const auto& attributes =
        given && given->kind == Kind::tuple && !given->items.empty() ? given->items[0] : state;
    if (!attributes.is_dict()) fail(fmt::format("{} for an object's attributes", attributes.what()));
    note_depth(object, attributes);
    object.items.assign(1, attributes);
}

void PickleMaker::fill(const PickleValue& instance, const PickleValue& state) {
    auto& node = mutable_node(instance);
    switch (node.kind) {
        case Kind::type:
            return fill_type(node, state);
        case Kind::array:
        case Kind::unfilled:
            return fill_array(node, state);
        case Kind::object:
            if (node.of->makes == Makes::joblib_array) return fill_from_file(node, state);
            charge(sizeof(PickleValue) + overhead);
            return fill_object(node, state);
        case Kind::dict:
            if (limits_.tensors) return;  // a state_dict's versions of its modules
            [[fallthrough]];
        default:
            fail(fmt::format("{} with attributes", instance.what()));
    }
}

}  // namespace actformer
