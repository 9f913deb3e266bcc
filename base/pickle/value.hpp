// What a pickle holds, as plain values: nothing of it was run.
//
// A value is small, is copied freely and lives as long as its Pickle. Arrays and most texts are views of the file's bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "base/numpy/array.hpp"

namespace actformer {

struct PickleNode;
struct PickleGlobal;

/// Functions that ask for a kind throw Error where the value is of another one, as in "byte 12: a list, not a dict". They do not name
/// the file.
class PickleValue {
  public:
    struct Text {
        std::string_view utf8;
    };
    struct Bytes {  ///< also every text that Python 2 wrote: latin-1
        std::string_view bytes;
    };
    using Held = std::variant<std::monostate, bool, std::int64_t, double, Text, Bytes, const PickleNode*,
                              const PickleGlobal*>;

    PickleValue() = default;
    PickleValue(Held held, std::uint64_t at) : held_(held), at_(at) {}

    /// The byte of the (unpacked) file at which it stands.
    std::uint64_t at() const { return at_; }

    /// "a list", "an array of <f8 (90, 72)", "a chumpy.ch Ch"
    std::string what() const;

    bool is_none() const { return std::holds_alternative<std::monostate>(held_); }
    bool is_text() const {
        return std::holds_alternative<Text>(held_) || std::holds_alternative<Bytes>(held_);
    }
    bool is_sequence() const;  ///< list, tuple, set or call
    bool is_dict() const;
    bool is_array() const;

    /// An instance of the class that pickles call so, as in "chumpy.ch Ch".
    bool is_object(std::string_view called) const;

    /// A call that is kept as it stands, of what pickles call so; its arguments are elements, as of a tuple.
    bool is_call(std::string_view called) const;

    /// What a value is called by that lies elsewhere in the file; none of others.
    std::optional<PickleValue> reference() const;

    bool truth() const;
    std::int64_t whole() const;
    double real() const;  ///< a whole number too

    /// A text as UTF-8; bytes are taken for latin-1.
    std::string text() const;
    std::string_view bytes() const;  ///< of a text or of bytes, as they lie in the file
    const NumpyArray& array() const;

    /// Of a list, tuple, set or dict.
    std::size_t size() const;

    /// The i-th of a list, tuple or set.
    PickleValue operator[](std::size_t i) const;

    /// The i-th key and value of a dict.
    std::pair<PickleValue, PickleValue> entry(std::size_t i) const;

    /// What a dict has under a key, or an object has for an attribute; find() gives none where there is no such key, get() throws
    /// Error with the keys that there are.
    std::optional<PickleValue> find(std::string_view key) const;
    std::optional<PickleValue> find(std::int64_t key) const;
    PickleValue get(std::string_view key) const;

    const Held& held() const { return held_; }

  private:
    const PickleNode* node() const;
    const PickleNode& dict() const;
    [[noreturn]] void not_a(std::string_view wanted) const;
    template <typename Is>
    std::optional<PickleValue> find_if(Is is) const;

    Held held_;
    std::uint64_t at_ = 0;
};

}  // namespace actformer
