#include "base/numpy/array.hpp"

#include <bit>
#include <cstring>

#include "base/error.hpp"
#include "base/numpy/binary16.hpp"
#include "base/text/printable.hpp"
#include "base/text/utf8.hpp"

namespace actformer {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

NumpyArray::Kind kind_of(char kind, std::size_t size) {
    using Kind = NumpyArray::Kind;
    const bool word = size == 1 || size == 2 || size == 4 || size == 8;
    if (kind == 'f' && word && size > 1) return Kind::real;
    if (kind == 'i' && word) return Kind::whole;
    if ((kind == 'u' && word) || (kind == 'b' && size == 1)) return Kind::natural;
    if ((kind == 'S' || kind == 'U') && size > 0) return Kind::text;
    return Kind::other;
}

template <typename Word, typename Number>
void copy_as(const char* from, std::uint64_t stride, std::uint64_t count, bool swapped, Number number,
             double* to) {
    const auto load = [&](std::uint64_t i) {
        Word word;
        std::memcpy(&word, from + i * stride * sizeof word, sizeof word);
        return word;
    };
    if (!swapped && stride == 1) {  // the usual case, for the compiler to turn into vectors
        for (std::uint64_t i = 0; i < count; ++i) {
            Word word;
            std::memcpy(&word, from + i * sizeof word, sizeof word);
            to[i] = number(word);
        }
        return;
    }
    for (std::uint64_t i = 0; i < count; ++i) {
        auto word = load(i);
        if (swapped) {
            char bytes[sizeof word];
            std::memcpy(bytes, &word, sizeof word);
            for (std::size_t b = 0; b < sizeof word / 2; ++b) std::swap(bytes[b], bytes[sizeof word - 1 - b]);
            std::memcpy(&word, bytes, sizeof word);
        }
        to[i] = number(word);
    }
}

}  // namespace

bool NumpyArray::take_type(std::string_view spelled) {
    if (spelled.size() < 2 || std::string_view("<>|=").find(spelled[0]) == std::string_view::npos)
        return false;
    type = printable(spelled.substr(0, 40));  // for messages of one line
    big_endian = spelled[0] == '>';
    const char letter = spelled[1];
    std::size_t number = 0;
    for (const char c : spelled.substr(2, 6)) {
        if (c < '0' || c > '9') break;
        number = number * 10 + static_cast<std::size_t>(c - '0');
    }
    wide = letter == 'U';
    size = wide ? 4 * number : number;
    kind = kind_of(letter, number);
    return true;
}

std::optional<std::uint64_t> NumpyArray::bytes() const {
    std::uint64_t all = size;
    for (const auto n : shape)
        if (__builtin_mul_overflow(all, n, &all)) return {};
    return all;
}

std::uint64_t NumpyArray::elements() const {
    std::uint64_t all = 1;
    for (const auto n : shape) all *= n;
    return all;
}

std::string NumpyArray::shape_text() const {
    return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

void NumpyArray::copy(std::uint64_t first, std::uint64_t stride, std::uint64_t count, double* to) const {
    const char* from = values.data() + first * size;
    const auto as = [&]<typename Word, typename Stored>(Word, Stored) {
        copy_as<Word>(
            from, stride, count, big_endian && size > 1,
            [](Word word) { return static_cast<double>(std::bit_cast<Stored>(word)); }, to);
    };
    using std::uint16_t, std::uint32_t, std::uint64_t, std::uint8_t;
    switch (kind) {
        case Kind::real:
            if (size == 2) return copy_as<uint16_t>(from, stride, count, big_endian, of_binary16, to);
            return size == 4 ? as(uint32_t{}, float{}) : as(uint64_t{}, double{});
        case Kind::whole:
            if (size == 1) return as(uint8_t{}, std::int8_t{});
            if (size == 2) return as(uint16_t{}, std::int16_t{});
            return size == 4 ? as(uint32_t{}, std::int32_t{}) : as(uint64_t{}, std::int64_t{});
        case Kind::natural:
            if (size == 1) return as(uint8_t{}, uint8_t{});
            if (size == 2) return as(uint16_t{}, uint16_t{});
            return size == 4 ? as(uint32_t{}, uint32_t{}) : as(uint64_t{}, uint64_t{});
        case Kind::text:
        case Kind::other:
            break;
    }
    throw Error("an array of type {}, which is no number", in_quotes(type));
}

std::vector<double> NumpyArray::all_numbers() const {
    std::vector<double> out(elements());
    copy(0, 1, out.size(), out.data());
    return out;
}

std::vector<std::string> NumpyArray::all_texts() const {
    std::vector<std::string> out(elements());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto bytes = values.substr(i * size, size);
        if (!wide) {
            out[i] = bytes.substr(0, bytes.find('\0'));
            continue;
        }
        for (std::size_t at = 0; at < size; at += 4) {
            double character = 0;
            copy_as<std::uint32_t>(
                bytes.data() + at, 1, 1, big_endian,
                [](std::uint32_t word) { return static_cast<double>(word); }, &character);
            if (character == 0) break;
            if (!append_utf8(static_cast<std::uint32_t>(character), out[i]))
                throw Error("an array of texts with the number {:.0f}, which is no character: damaged",
                            character);
        }
    }
    return out;
}

}  // namespace actformer
