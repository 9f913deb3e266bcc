#include "base/numpy/npy.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

constexpr std::string_view magic = "\x93NUMPY";

/// A dictionary such as {'descr': '<f4', 'fortran_order': False, 'shape': (60, 25, 3), }.
class HeaderReader {
  public:
    explicit HeaderReader(std::string_view text) : left_(text) {}

    NumpyArray read() {
        NumpyArray array;
        bool type = false, order = false, shape = false;
        expect('{');
        while (!next_is('}')) {
            const auto key = quoted();
            expect(':');
            if (key == "descr") {
                read_type(array);
                type = true;
            } else if (key == "fortran_order") {
                array.fortran_order = truth();
                order = true;
            } else if (key == "shape") {
                array.shape = whole_numbers();
                shape = true;
            } else {
                damaged();
            }
            if (!next_is('}')) expect(',');
        }
        if (!type || !order || !shape) damaged();
        return array;
    }

  private:
    [[noreturn]] static void damaged() { throw Error("the header is no NumPy header: damaged"); }

    void skip_blanks() {
        while (!left_.empty() && (left_[0] == ' ' || left_[0] == '\n')) left_.remove_prefix(1);
    }

    bool next_is(char c) {
        skip_blanks();
        return !left_.empty() && left_[0] == c;
    }

    void expect(char c) {
        if (!next_is(c)) damaged();
        left_.remove_prefix(1);
    }

    std::string_view quoted() {
        if (!next_is('\'') && !next_is('"')) damaged();
        const auto end = left_.find(left_[0], 1);
        if (end == std::string_view::npos) damaged();
        const auto text = left_.substr(1, end - 1);
        left_.remove_prefix(end + 1);
        return text;
    }

    bool truth() {
        skip_blanks();
        for (const std::string_view word : {"False", "True"})
            if (left_.starts_with(word)) {
                left_.remove_prefix(word.size());
                return word == "True";
            }
        damaged();
    }

    std::uint64_t whole_number() {
        skip_blanks();
        std::size_t digits = 0;
        std::uint64_t value = 0;
        for (; digits < left_.size() && left_[digits] >= '0' && left_[digits] <= '9'; ++digits) {
            if (value > std::numeric_limits<std::uint64_t>::max() / 10 - 1) damaged();
            value = value * 10 + static_cast<std::uint64_t>(left_[digits] - '0');
        }
        if (digits == 0) damaged();
        left_.remove_prefix(digits);
        if (!left_.empty() && left_[0] == 'L') left_.remove_prefix(1);  // as Python 2 wrote them
        return value;
    }

    std::vector<std::uint64_t> whole_numbers() {
        std::vector<std::uint64_t> values;
        expect('(');
        while (!next_is(')')) {
            values.push_back(whole_number());
            if (!next_is(')')) expect(',');
        }
        expect(')');
        return values;
    }

    void read_type(NumpyArray& array) {
        if (next_is('[')) throw Error("a structured array; save one array of numbers for each of its fields");
        array.type = quoted();
        std::string_view type = array.type;
        if (type.find('O') != std::string_view::npos)
            throw Error(
                "an array of Python objects, which only running code could read; save arrays of numbers, as "
                "with "
                "x.astype('float32') for each clip");
        if (type.empty() || std::string_view("<>|=").find(type[0]) == std::string_view::npos) damaged();
        array.big_endian = type[0] == '>';
        type.remove_prefix(1);
        if (type.empty()) damaged();
        const char kind = type[0];
        type.remove_prefix(1);
        std::size_t size = 0;
        for (const char c : type.substr(0, 6)) {
            if (c < '0' || c > '9') break;
            size = size * 10 + static_cast<std::size_t>(c - '0');
        }
        array.wide = kind == 'U';
        array.size = array.wide ? 4 * size : size;
        array.kind = kind_of(kind, size);
    }

    static NumpyArray::Kind kind_of(char kind, std::size_t size) {
        using Kind = NumpyArray::Kind;
        const bool word = size == 1 || size == 2 || size == 4 || size == 8;
        if (kind == 'f' && word && size > 1) return Kind::real;
        if (kind == 'i' && word) return Kind::whole;
        if ((kind == 'u' && word) || (kind == 'b' && size == 1)) return Kind::natural;
        if ((kind == 'S' || kind == 'U') && size > 0) return Kind::text;
        return Kind::other;
    }

    std::string_view left_;
};

/// IEEE 754 binary16.
double half(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double magnitude = exponent == 0    ? std::ldexp(fraction, -24)
                             : exponent == 31 ? (fraction ? std::numeric_limits<double>::quiet_NaN()
                                                          : std::numeric_limits<double>::infinity())
                                              : std::ldexp(1024 + fraction, exponent - 25);
    return bits >> 15 ? -magnitude : magnitude;
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

void append_utf8(std::uint32_t character, std::string& text) {
    const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
    if (character < 0x80) return byte(character);
    if (character < 0x800) {
        byte(0xC0 | character >> 6);
        return byte(0x80 | (character & 63));
    }
    if (character < 0x10000) {
        byte(0xE0 | character >> 12);
    } else {
        byte(0xF0 | (character >> 18 & 7));
        byte(0x80 | (character >> 12 & 63));
    }
    byte(0x80 | (character >> 6 & 63));
    byte(0x80 | (character & 63));
}

/// Bytes that `array` needs; none where they cannot be counted.
bool count_bytes(const NumpyArray& array, std::uint64_t& bytes) {
    bytes = array.size;
    for (const auto n : array.shape)
        if (__builtin_mul_overflow(bytes, n, &bytes)) return false;
    return true;
}

}  // namespace

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
            if (size == 2) return copy_as<uint16_t>(from, stride, count, big_endian, half, to);
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
            append_utf8(static_cast<std::uint32_t>(character), out[i]);
        }
    }
    return out;
}

namespace {

struct Header {
    NumpyArray array;
    std::size_t size = 0;  ///< bytes
};

Header read_header(std::string_view bytes) {
    if (!bytes.starts_with(magic)) throw Error("not a NumPy array: it does not begin with \\x93NUMPY");
    if (bytes.size() < 12) throw Error("cut short in the header");
    const int version = static_cast<unsigned char>(bytes[6]);
    if (version < 1 || version > 3) throw Error("NumPy format version {}; 1 to 3 are known", version);
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 8, version == 1 ? 2 : 4);
    const std::size_t before = version == 1 ? 10 : 12;
    if (length > bytes.size() - before) throw Error("cut short in the header");
    return {HeaderReader(bytes.substr(before, length)).read(), before + length};
}

}  // namespace

NumpyArray read_npy_header(std::string_view bytes) {
    return read_header(bytes).array;
}

NumpyArray read_npy(std::string_view bytes) {
    auto [array, before] = read_header(bytes);
    if (array.kind == NumpyArray::Kind::other) return array;
    const auto values = bytes.substr(before);
    std::uint64_t wanted = 0;
    if (!count_bytes(array, wanted) || wanted > values.size())
        throw Error("{} {} numbers do not fit into {} bytes: cut short", array.shape_text(), array.type,
                    values.size());
    if (wanted < values.size())
        throw Error("{} bytes behind the last number of {} {}", values.size() - wanted, array.shape_text(),
                    array.type);
    array.values = values;
    return array;
}

}  // namespace actformer
