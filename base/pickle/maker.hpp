// What calling a name makes, and what the state of an instance means.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/pickle/node.hpp"
#include "base/pickle/pickle.hpp"
#include "base/pickle/text.hpp"

namespace actformer {

/// Makes values in a store, within limits. Throws Error naming the byte of the opcode in hand.
class PickleMaker {
  public:
    using Arguments = std::span<const PickleValue>;

    PickleMaker(PickleText& text, const PickleLimits& limits, PickleStore& store);

    [[noreturn]] void fail(std::string_view what) const;

    /// Counts bytes that values take.
    void charge(std::uint64_t bytes);

    PickleValue value(PickleValue::Held held) const { return {held, text_.opcode_at()}; }
    PickleValue value(const PickleNode& node) const { return value(PickleValue::Held(&node)); }
    PickleNode& node(PickleNode::Kind kind, std::vector<PickleValue> items = {});

    /// Appends to a list, set or dict.
    void add(const PickleValue& container, PickleNode::Kind kind, Arguments items);

    /// A text that is not in the file as it is.
    std::string_view spelled(std::string_view line, std::string (*decode)(std::string_view));

    std::string_view text(const PickleValue& value) const;

    /// A name of the table; others are refused.
    PickleValue global(std::string_view module, std::string_view name) const;

    /// `called`(`arguments`), a tuple or the arguments themselves.
    PickleValue call(const PickleValue& called, const PickleValue& arguments);
    PickleValue call(const PickleValue& called, Arguments arguments);

    /// Gives `instance` its state. An array of joblib takes its numbers from the text.
    void fill(const PickleValue& instance, const PickleValue& state);

  private:
    PickleValue type(Arguments arguments);
    PickleValue array(Arguments arguments);
    PickleValue scalar(Arguments arguments);
    PickleValue from_buffer(Arguments arguments);
    PickleValue bytes(Arguments arguments);
    PickleValue container(PickleNode::Kind kind, Arguments arguments);
    PickleValue dict(Arguments arguments);
    PickleValue instance(Arguments arguments);
    PickleValue object(const PickleGlobal& of);
    PickleValue kept_call(const PickleGlobal& of, Arguments arguments);

    void fill_type(PickleNode& type, const PickleValue& state) const;
    void fill_array(PickleNode& array, const PickleValue& state);
    void fill_from_file(PickleNode& object, const PickleValue& state);
    void fill_object(PickleNode& object, const PickleValue& state) const;

    PickleNode& mutable_node(const PickleValue& value) const;
    Arguments items(const PickleValue& tuple) const;
    void note_depth(PickleNode& outer, const PickleValue& inner) const;
    void set_type(NumpyArray& array, const PickleValue& type) const;
    void set_shape(NumpyArray& array, const PickleValue& shape) const;
    std::uint64_t size_of(const NumpyArray& array);

    PickleText& text_;
    PickleLimits limits_;
    PickleStore& store_;
    std::uint64_t memory_ = 0, array_bytes_ = 0, most_array_bytes_;
};

}  // namespace actformer
