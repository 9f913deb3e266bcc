#include "ingest/synth/pickle_writer.hpp"

#include <bit>

namespace actformer::ingest::synth {
namespace {

static_assert(std::endian::native == std::endian::little, "pickles hold little-endian numbers");

template <typename T>
std::string_view bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

template <typename T>
std::string_view bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

PickleWriter::PickleWriter() : text_("\x80\x04") {}

void PickleWriter::text(std::string_view value) {
    text_ += 'X';  // BINUNICODE
    text_ += bytes_of(static_cast<std::uint32_t>(value.size()));
    text_ += value;
}

void PickleWriter::integer(std::int32_t value) {
    text_ += 'J';  // BININT
    text_ += bytes_of(value);
}

void PickleWriter::number(double value) {
    text_ += 'G';  // BINFLOAT, the only one with its highest byte first
    const auto bytes = bytes_of(value);
    text_.append(bytes.rbegin(), bytes.rend());
}

void PickleWriter::array(const Shape& shape, std::span<const double> values) {
    array_of(shape, "f8", bytes_of(values));
}

void PickleWriter::array(const Shape& shape, std::span<const float> values) {
    array_of(shape, "f4", bytes_of(values));
}

void PickleWriter::array(const Shape& shape, std::span<const std::int64_t> values) {
    array_of(shape, "i8", bytes_of(values));
}

/// As NumPy pickles its arrays: an empty one, then its state (1, shape, type, Fortran order, bytes).
void PickleWriter::array_of(const Shape& shape, std::string_view type, std::string_view bytes) {
    using namespace std::string_view_literals;
    text_ +=
        "cnumpy.core.multiarray\n_reconstruct\n(cnumpy\nndarray\nK\0\x85"
        "C\x01"
        "btR"sv;
    text_ += "(K\x01("sv;
    for (const auto n : shape) {
        text_ += "\x8a\x08"sv;  // LONG1 of eight bytes
        text_ += bytes_of(n);
    }
    text_ += 't';
    text_ += "cnumpy\ndtype\n("sv;
    text(type);
    text_ += "\x89\x88tR(K\x03"sv;
    text("<");
    text_ += "NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\0tb"sv;
    text_ += "\x89\x8e"sv;  // not in Fortran order; BINBYTES8
    text_ += bytes_of(static_cast<std::uint64_t>(bytes.size()));
    text_ += bytes;
    text_ += "tb"sv;
}

std::string PickleWriter::finish() {
    text_ += '.';
    return std::move(text_);
}

}  // namespace actformer::ingest::synth
