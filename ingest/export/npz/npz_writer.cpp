#include "ingest/export/npz/npz_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/text/printable.hpp"
#include "base/text/utf8.hpp"

namespace actformer::ingest {
namespace {

static_assert(std::endian::native == std::endian::little, "the types written below are little-endian");

/// Magic number, version 1.0, the length of what follows, and a Python dictionary filled up so that the numbers begin at a
/// multiple of 64 bytes.
std::string header(const std::string& type, const NpzWriter::Shape& shape) {
    const auto sizes = fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
    auto text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, sizes);
    constexpr std::size_t before = 10, block = 64;
    text.resize((before + text.size() + 1 + block - 1) / block * block - before - 1, ' ');
    text += '\n';
    std::string out("\x93NUMPY\x01\x00", 8);
    out += static_cast<char>(text.size() & 0xFF);
    out += static_cast<char>(text.size() >> 8);
    return out + text;
}

/// The code points of a text in UTF-8, U+FFFD for what is none.
std::u32string code_points(std::string_view text) {
    std::u32string out;
    while (!text.empty()) {
        const auto character = first_character(text);
        out += character ? static_cast<char32_t>(character->code) : U'\uFFFD';
        text.remove_prefix(character ? character->bytes : 1);
    }
    return out;
}

template <typename T>
std::string_view bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

void NpzWriter::add_bytes(const std::string& name, const std::string& type, const Shape& shape,
                          std::string_view bytes) {
    const auto head = header(type, shape);
    const std::string_view parts[] = {head, bytes};
    zip_.add(name + ".npy", parts);
}

void NpzWriter::add(const std::string& name, const Shape& shape, std::span<const float> values) {
    add_bytes(name, "<f4", shape, bytes_of(values));
}

void NpzWriter::add(const std::string& name, const Shape& shape, std::span<const double> values) {
    add_bytes(name, "<f8", shape, bytes_of(values));
}

void NpzWriter::add(const std::string& name, const Shape& shape, std::span<const std::int64_t> values) {
    add_bytes(name, "<i8", shape, bytes_of(values));
}

void NpzWriter::add(const std::string& name, const std::vector<std::string>& texts) {
    add_texts(name, {texts.size()}, texts);
}

void NpzWriter::add(const std::string& name, const std::string& text) {
    add_texts(name, {}, {&text, 1});
}

void NpzWriter::add_texts(const std::string& name, const Shape& shape, std::span<const std::string> texts) {
    std::vector<std::u32string> all;
    std::size_t width = 1;
    for (const auto& text : texts) {
        all.push_back(code_points(printable(text)));
        width = std::max(width, all.back().size());
    }
    std::u32string packed;
    for (auto& text : all) {
        text.resize(width, U'\0');
        packed += text;
    }
    add_bytes(name, fmt::format("<U{}", width), shape, bytes_of(std::span<const char32_t>(packed)));
}

}  // namespace actformer::ingest
