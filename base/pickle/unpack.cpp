#include "base/pickle/unpack.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "base/error.hpp"

namespace actformer {
namespace {

constexpr std::string_view zf = "ZF";
constexpr std::size_t zf_header = 21;  // with the length in hexadecimal, padded with blanks

/// Room behind `out` for more: as much again as it holds, from 16 KiB up to 1 MiB.
std::size_t add_room(std::string& out) {
    const auto room = std::clamp(out.size(), std::size_t{16} << 10, std::size_t{1} << 20);
    out.resize(out.size() + room);
    return room;
}

[[noreturn]] void damaged() {
    throw Error("the compressed file is damaged or cut short; get it again");
}

void check_size(std::size_t size, std::uint64_t most) {
    if (size > most)
        throw Error("the compressed file holds more than {} MiB; decompress it and give it so", most >> 20);
}

/// With a window of 32 KiB, as Python makes it; such a beginning is no opcode.
bool is_zlib(std::string_view text) {
    if (text.size() < 2 || text[0] != 0x78) return false;
    return ((static_cast<unsigned char>(text[0]) << 8) + static_cast<unsigned char>(text[1])) % 31 == 0;
}

/// zlib or gzip, whichever it is.
std::string inflate_all(std::string_view text, std::uint64_t most) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 32) != Z_OK) throw Error("no memory to decompress the file");
    const std::unique_ptr<z_stream, decltype(&inflateEnd)> ends(&stream, &inflateEnd);
    std::string out;
    for (int state = Z_OK; state != Z_STREAM_END;) {
        if (stream.avail_in == 0) {
            const auto piece = text.substr(0, std::numeric_limits<uInt>::max());
            if (piece.empty()) damaged();
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
            stream.avail_in = static_cast<uInt>(piece.size());
            text.remove_prefix(piece.size());
        }
        const auto before = out.size();
        stream.avail_out = static_cast<uInt>(add_room(out));
        stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
        state = inflate(&stream, Z_NO_FLUSH);
        out.resize(out.size() - stream.avail_out);
        check_size(out.size(), most);
        if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR) damaged();
    }
    return out;
}

/// bzip2, xz or lzma.
std::string filter_all(std::string_view text, std::uint64_t most) {
    const std::unique_ptr<archive, decltype(&archive_read_free)> reader(archive_read_new(),
                                                                        &archive_read_free);
    archive_read_support_filter_bzip2(reader.get());
    archive_read_support_filter_xz(reader.get());
    archive_read_support_filter_lzma(reader.get());
    archive_read_support_format_raw(reader.get());
    archive_entry* entry = nullptr;
    if (archive_read_open_memory(reader.get(), text.data(), text.size()) != ARCHIVE_OK ||
        archive_read_next_header(reader.get(), &entry) != ARCHIVE_OK)
        damaged();
    std::string out;
    for (;;) {
        const auto before = out.size();
        const auto room = add_room(out);
        const auto got = archive_read_data(reader.get(), out.data() + before, room);
        if (got < 0) damaged();
        out.resize(before + static_cast<std::size_t>(got));
        check_size(out.size(), most);
        if (got == 0) return out;
    }
}

}  // namespace

std::optional<std::string> unpacked(std::string_view text, std::uint64_t most) {
    if (text.starts_with(zf)) {
        text.remove_prefix(std::min(text.size(), zf_header));
        if (text.starts_with(' ')) text.remove_prefix(1);  // of joblib below 0.8.4 on Python 2
        return inflate_all(text, most);
    }
    using namespace std::string_view_literals;
    if (is_zlib(text) || text.starts_with("\x1F\x8B"sv)) return inflate_all(text, most);
    for (const auto magic : {"BZh"sv, "\xFD\x37zXZ\0"sv, "\x5D\0\0"sv})
        if (text.starts_with(magic)) return filter_all(text, most);
    return {};
}

}  // namespace actformer
