// The machine that a pickle is a program for: a stack of values, marks on it, and a memo.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/pickle/maker.hpp"
#include "base/pickle/pickle.hpp"
#include "base/pickle/text.hpp"

namespace actformer {

class PickleMachine {
  public:
    /// What it makes lies in `store`.
    PickleMachine(std::string_view text, const PickleLimits& limits, PickleStore& store);

    /// Runs to STOP and returns what is then on top of the stack. Throws Error naming the byte.
    PickleValue run(const Pickle::Passed& passed);

    /// Bytes of the text that were read.
    std::uint64_t taken() const { return size_ - text_.left(); }

  private:
    // Opcodes of a kind; false where `code` is none of it.
    bool numbers(unsigned char code);
    bool texts(unsigned char code);
    bool containers(unsigned char code);
    bool stack(unsigned char code);
    bool memo(unsigned char code);
    bool objects(unsigned char code);

    void push(PickleValue::Held held);
    void push(const PickleValue& value);
    PickleValue& top();
    PickleValue pop();
    std::vector<PickleValue> pop(std::size_t count);  ///< the topmost last
    std::vector<PickleValue> pop_to_mark();
    void put(std::uint64_t index);
    void get(std::uint64_t index);

    std::int64_t whole_of(std::string_view bytes) const;
    PickleValue::Held spelled_whole(std::string_view line) const;
    double spelled_real(std::string_view line) const;
    std::uint64_t spelled_index();

    PickleText text_;
    PickleMaker maker_;
    std::size_t nesting_;
    std::uint64_t size_;  ///< of the text
    bool tensors_;
    std::vector<PickleValue> stack_, memo_;
    std::vector<std::size_t> marks_;  ///< sizes of the stack
    std::size_t highest_ = 0;         ///< size of the stack so far
};

}  // namespace actformer
