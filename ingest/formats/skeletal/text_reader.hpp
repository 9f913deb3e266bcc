// Reading words, numbers and lines of a text format, with the place of a fault.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "base/text/lines.hpp"
#include "base/text/number.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// What is wrong, and where.
struct TextFault {
    const char* at;
    std::string reason;
};

inline bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}
inline bool is_blank(char c) {
    return is_space(c) || c == '\n';
}
inline bool is_brace(char c) {
    return c == '{' || c == '}';
}

/// `word` is `keyword`, given in capitals, in any case.
inline bool is(std::string_view word, std::string_view keyword) {
    const auto same = [](char a, char b) { return (a >= 'a' && a <= 'z' ? a - ('a' - 'A') : a) == b; };
    return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(), same);
}

/// Words, numbers and lines of the text. The zero bytes after its end stop every number.
class TextReader {
  public:
    explicit TextReader(std::string_view text)
        : p_(without_bom(text).data()), end_(text.data() + text.size()) {}

    const char* at() const { return p_; }
    void move_to(const char* p) { p_ = p; }
    bool at_end() const { return p_ == end_; }
    std::size_t left() const { return static_cast<std::size_t>(end_ - p_); }

    void skip_blanks() {
        while (p_ != end_ && is_blank(*p_)) ++p_;
    }

    void skip_spaces() {
        while (is_space(*p_)) ++p_;
    }

    /// The next word, without moving past it: characters up to a blank or a brace, or one brace. Empty at the
    /// end.
    std::string_view peek() {
        skip_blanks();
        const char* q = p_;
        if (q != end_ && is_brace(*q)) return {q, 1};
        while (q != end_ && !is_blank(*q) && !is_brace(*q)) ++q;
        return {p_, static_cast<std::size_t>(q - p_)};
    }

    std::string_view word() {
        const auto w = peek();
        p_ = w.data() + w.size();
        return w;
    }

    /// Something but blanks is left of the line.
    bool more_on_line() {
        skip_spaces();
        return p_ != end_ && *p_ != '\n';
    }

    void skip_line() {
        while (p_ != end_ && *p_ != '\n') ++p_;
    }

    /// What is left of the line, or of it before a brace, without the blanks around it.
    std::string_view rest_of_line() {
        skip_spaces();
        const char* q = p_;
        while (q != end_ && *q != '\n' && !is_brace(*q)) ++q;
        std::string_view rest(p_, static_cast<std::size_t>(q - p_));
        p_ = q;
        while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
        return rest;
    }

    /// The number that comes next; `what` it is for the fault where it is none, or larger than `limit`.
    double number(const char* what, double limit) {
        skip_blanks();
        double value = 0;
        const char* q = parse_number(p_, value);
        if (!q || !(q == end_ || is_blank(*q) || is_brace(*q))) fail("{} in place of {}", shown(), what);
        if (std::abs(value) > limit) fail("{} is too large for {}", shown(), what);
        p_ = q;
        return value;
    }

    /// The next word for messages.
    std::string shown() {
        const auto w = peek();
        return w.empty() ? "the end of the text" : in_quotes(w);
    }

    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
        throw TextFault{p_, fmt::format(reason, std::forward<Args>(args)...)};
    }

  private:
    const char* p_;
    const char* end_;
};

/// What read(TextReader&) makes of `text`, or a Rejection that names the line of its fault. 64 zero bytes follow the text.
template <typename Read>
auto read_text_with(std::string_view text, const Read& read)
    -> std::variant<decltype(read(std::declval<TextReader&>())), Rejection> {
    try {
        TextReader reader(text);
        return read(reader);
    } catch (const TextFault& fault) {
        const auto line = 1 + std::count(text.data(), fault.at, '\n');
        return Rejection{Rejection::Kind::broken, fmt::format("line {}: {}", line, fault.reason)};
    }
}

}  // namespace actformer::ingest
