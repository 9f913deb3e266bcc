#include "base/pickle/machine.hpp"

#include <bit>
#include <charconv>

#include "base/text/printable.hpp"

namespace actformer {
namespace {

using Kind = PickleNode::Kind;
using Text = PickleValue::Text;
using Bytes = PickleValue::Bytes;

constexpr std::ptrdiff_t passed_at_once = 8 << 20;

/// From IEEE 754 binary64, the highest byte first.
double big_endian(std::string_view eight) {
    std::uint64_t bits = 0;
    for (const char c : eight) bits = bits << 8 | static_cast<unsigned char>(c);
    return std::bit_cast<double>(bits);
}

/// All of `line` as a number; false where it is none, or none that fits.
template <typename Number>
bool read_all(std::string_view line, Number& number) {
    const auto [end, fault] = std::from_chars(line.data(), line.data() + line.size(), number);
    return fault == std::errc() && end == line.data() + line.size();
}

}  // namespace

PickleMachine::PickleMachine(std::string_view text, const PickleLimits& limits, PickleStore& store)
    : text_(text),
      maker_(text_, limits, store),
      nesting_(limits.nesting),
      size_(text.size()),
      tensors_(limits.tensors) {}

PickleValue PickleMachine::run(const Pickle::Passed& passed) {
    constexpr unsigned char stop = '.';
    for (const char* last = text_.here();;) {
        const auto code = text_.opcode();
        if (code == stop) return pop();
        if (!numbers(code) && !texts(code) && !containers(code) && !stack(code) && !memo(code) &&
            !objects(code))
            maker_.fail(fmt::format("0x{:02x} is no opcode: not a pickle, or a damaged one", code));
        if (passed && text_.here() - last >= passed_at_once) passed(last = text_.here());
    }
}

void PickleMachine::push(const PickleValue& value) {
    if (stack_.size() == highest_) {
        maker_.charge(sizeof(PickleValue));
        ++highest_;
    }
    stack_.push_back(value);
}

void PickleMachine::push(PickleValue::Held held) {
    push(maker_.value(held));
}

PickleValue& PickleMachine::top() {
    if (stack_.size() == (marks_.empty() ? 0 : marks_.back())) maker_.fail("nothing on the stack");
    return stack_.back();
}

PickleValue PickleMachine::pop() {
    const auto value = top();
    stack_.pop_back();
    return value;
}

std::vector<PickleValue> PickleMachine::pop(std::size_t count) {
    std::vector<PickleValue> out(count);
    while (count-- > 0) out[count] = pop();
    return out;
}

std::vector<PickleValue> PickleMachine::pop_to_mark() {
    if (marks_.empty()) maker_.fail("no mark on the stack");
    const auto first = stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back());
    std::vector<PickleValue> out(first, stack_.end());
    stack_.erase(first, stack_.end());
    marks_.pop_back();
    return out;
}

bool PickleMachine::numbers(unsigned char code) {
    switch (code) {
        case 'N':
            push(std::monostate());
            return true;
        case 0x88:
        case 0x89:
            push(code == 0x88);
            return true;
        case 'J':
            push(std::int64_t{text_.number<std::int32_t>()});
            return true;
        case 'K':
            push(std::int64_t{text_.number<std::uint8_t>()});
            return true;
        case 'M':
            push(std::int64_t{text_.number<std::uint16_t>()});
            return true;
        case 0x8A:
            push(whole_of(text_.take(text_.number<std::uint8_t>())));
            return true;
        case 0x8B:
            push(whole_of(text_.take(text_.number<std::uint32_t>())));
            return true;
        case 'I':
        case 'L':
            push(spelled_whole(text_.line()));
            return true;
        case 'G':
            push(big_endian(text_.take(8)));
            return true;
        case 'F':
            push(spelled_real(text_.line()));
            return true;
    }
    return false;
}

/// Two's complement, the lowest byte first.
std::int64_t PickleMachine::whole_of(std::string_view bytes) const {
    if (bytes.size() > 8) maker_.fail("a whole number of more than 64 bits");
    std::uint64_t bits = !bytes.empty() && static_cast<signed char>(bytes.back()) < 0 ? ~std::uint64_t{0} : 0;
    for (auto i = bytes.size(); i-- > 0;) bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
    return static_cast<std::int64_t>(bits);
}

PickleValue::Held PickleMachine::spelled_whole(std::string_view line) const {
    if (line == "00" || line == "01") return line == "01";  // False and True
    if (line.ends_with('L')) line.remove_suffix(1);
    std::int64_t whole = 0;
    if (!read_all(line, whole)) maker_.fail(in_quotes(line) + " is no whole number of 64 bits");
    return whole;
}

double PickleMachine::spelled_real(std::string_view line) const {
    double real = 0;
    if (!read_all(line, real)) maker_.fail(in_quotes(line) + " is no number");
    return real;
}

bool PickleMachine::texts(unsigned char code) {
    switch (code) {
        case 0x8C:
            push(Text{text_.take(text_.number<std::uint8_t>())});
            return true;
        case 'X':
            push(Text{text_.take(text_.number<std::uint32_t>())});
            return true;
        case 0x8D:
            push(Text{text_.take(text_.number<std::uint64_t>())});
            return true;
        case 'C':
        case 'U':
            push(Bytes{text_.take(text_.number<std::uint8_t>())});
            return true;
        case 'B':
        case 'T':
            push(Bytes{text_.take(text_.number<std::uint32_t>())});
            return true;
        case 0x8E:
        case 0x96:
            push(Bytes{text_.take(text_.number<std::uint64_t>())});
            return true;
        case 'S':
            push(Bytes{maker_.spelled(text_.line(), of_quoted_bytes)});
            return true;
        case 'V':
            push(Text{maker_.spelled(text_.line(), of_escaped_unicode)});
            return true;
    }
    return false;
}

bool PickleMachine::containers(unsigned char code) {
    const auto made = [&](Kind kind, std::vector<PickleValue> items = {}) {
        push(maker_.value(maker_.node(kind, std::move(items))));
        return true;
    };
    const auto added = [&](Kind kind, const std::vector<PickleValue>& items) {
        maker_.add(top(), kind, items);
        return true;
    };
    switch (code) {
        case ')':
            return made(Kind::tuple);
        case ']':
            return made(Kind::list);
        case '}':
            return made(Kind::dict);
        case 0x8F:
            return made(Kind::set);
        case 't':
            return made(Kind::tuple, pop_to_mark());
        case 0x85:
        case 0x86:
        case 0x87:
            return made(Kind::tuple, pop(code - 0x84U));
        case 'l':
            return made(Kind::list, pop_to_mark());
        case 0x91:
            return made(Kind::set, pop_to_mark());
        case 'd': {
            const auto items = pop_to_mark();
            return made(Kind::dict) && added(Kind::dict, items);
        }
        case 'a':
            return added(Kind::list, pop(1));
        case 'e':
            return added(Kind::list, pop_to_mark());
        case 0x90:
            return added(Kind::set, pop_to_mark());
        case 's':
            return added(Kind::dict, pop(2));
        case 'u':
            return added(Kind::dict, pop_to_mark());
    }
    return false;
}

bool PickleMachine::stack(unsigned char code) {
    switch (code) {
        case '(':
            if (marks_.size() == nesting_) maker_.fail("values nested too deep");
            marks_.push_back(stack_.size());
            return true;
        case '0':  // POP, which takes a mark where one is on top
            if (!marks_.empty() && marks_.back() == stack_.size())
                marks_.pop_back();
            else
                pop();
            return true;
        case '1':
            pop_to_mark();
            return true;
        case '2': {
            const auto value = top();
            push(value);
            return true;
        }
        case 0x80:  // PROTO
            if (const auto protocol = text_.number<std::uint8_t>(); protocol > 5)
                maker_.fail(fmt::format("pickle protocol {}; 0 to 5 are known", protocol));
            return true;
        case 0x95:  // FRAME: a length that helps those who read from a disk
            text_.take(8);
            return true;
        case 0x98:  // READONLY_BUFFER
            return true;
    }
    return false;
}

bool PickleMachine::memo(unsigned char code) {
    switch (code) {
        case 0x94:
            put(memo_.size());
            return true;
        case 'q':
            put(text_.number<std::uint8_t>());
            return true;
        case 'r':
            put(text_.number<std::uint32_t>());
            return true;
        case 'p':
            put(spelled_index());
            return true;
        case 'h':
            get(text_.number<std::uint8_t>());
            return true;
        case 'j':
            get(text_.number<std::uint32_t>());
            return true;
        case 'g':
            get(spelled_index());
            return true;
    }
    return false;
}

std::uint64_t PickleMachine::spelled_index() {
    std::uint64_t index = 0;
    const auto line = text_.line();
    if (!read_all(line, index)) maker_.fail(in_quotes(line) + " is no place in the memo");
    return index;
}

/// Writers count places up: there are no more of them than bytes before.
void PickleMachine::put(std::uint64_t index) {
    if (index > text_.opcode_at()) maker_.fail(fmt::format("place {} in a memo of {}", index, memo_.size()));
    if (index >= memo_.size()) {
        maker_.charge((index + 1 - memo_.size()) * sizeof(PickleValue));
        memo_.resize(index + 1);
    }
    memo_[index] = top();
}

void PickleMachine::get(std::uint64_t index) {
    if (index >= memo_.size()) maker_.fail(fmt::format("nothing at place {} of the memo", index));
    push(memo_[index]);
}

bool PickleMachine::objects(unsigned char code) {
    switch (code) {
        case 'c': {  // GLOBAL
            const auto module = text_.line(), name = text_.line();
            push(maker_.global(module, name));
            return true;
        }
        case 0x93: {  // STACK_GLOBAL
            const auto names = pop(2);
            push(maker_.global(maker_.text(names[0]), maker_.text(names[1])));
            return true;
        }
        case 'R':     // REDUCE
        case 0x81: {  // NEWOBJ
            const auto call = pop(2);
            push(maker_.call(call[0], call[1]));
            return true;
        }
        case 0x92: {  // NEWOBJ_EX
            const auto call = pop(3);
            if (!call[2].is_dict() || call[2].size() > 0) maker_.fail("a call with named arguments");
            push(maker_.call(call[0], call[1]));
            return true;
        }
        case 'i': {  // INST
            const auto module = text_.line(), name = text_.line();
            const auto called = maker_.global(module, name);
            push(maker_.call(called, pop_to_mark()));
            return true;
        }
        case 'o': {  // OBJ
            auto items = pop_to_mark();
            if (items.empty()) maker_.fail("an instance of nothing");
            const auto called = items.front();
            items.erase(items.begin());
            push(maker_.call(called, items));
            return true;
        }
        case 'b': {  // BUILD
            const auto state = pop();
            maker_.fill(top(), state);
            return true;
        }
        case 'Q':
            if (tensors_) {
                push(maker_.value(maker_.node(Kind::reference, pop(1))));
                return true;
            }
            [[fallthrough]];
        case 'P':
            maker_.fail("a value that its writer keeps elsewhere");
        case 0x82:
        case 0x83:
        case 0x84:
            maker_.fail("a name that only its writer's registry knows");
        case 0x97:
            maker_.fail("a buffer outside the file");
    }
    return false;
}

}  // namespace actformer
