#include "base/numpy/npy.hpp"

#include <cstring>
#include <limits>

#include "base/error.hpp"

namespace actformer {
namespace {

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
        const auto type = quoted();
        if (type.find('O') != std::string_view::npos)
            throw Error(
                "an array of Python objects, which only running code could read; save arrays of numbers, as "
                "with "
                "x.astype('float32') for each clip");
        if (!array.take_type(type)) damaged();
    }

    std::string_view left_;
};

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
    const auto wanted = array.bytes();
    if (!wanted || *wanted > values.size())
        throw Error("{} {} numbers do not fit into {} bytes: cut short", array.shape_text(), array.type,
                    values.size());
    if (*wanted < values.size())
        throw Error("{} bytes behind the last number of {} {}", values.size() - *wanted, array.shape_text(),
                    array.type);
    array.values = values;
    return array;
}

}  // namespace actformer
