#include "base/numpy/zip.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

constexpr std::string_view end_record = "PK\x05\x06", zip64_locator = "PK\x06\x07", zip64_end = "PK\x06\x06",
                           list_entry = "PK\x01\x02", local_header = "PK\x03\x04";
constexpr std::uint32_t in_zip64 = 0xFFFFFFFF;
constexpr std::size_t first_room = std::size_t{1} << 16;

[[noreturn]] void no_archive() {
    throw Error("no zip archive, or cut short");
}

/// Numbers at places of a text.
class Bytes {
  public:
    explicit Bytes(std::string_view text) : text_(text) {}

    template <typename Number>
    Number at(std::uint64_t place) const {
        Number number;
        std::memcpy(&number, part(place, sizeof number).data(), sizeof number);
        return number;
    }

    std::string_view part(std::uint64_t from, std::uint64_t size) const {
        if (from > text_.size() || size > text_.size() - from) no_archive();
        return text_.substr(from, size);
    }

    bool begins(std::uint64_t place, std::string_view signature) const {
        return place <= text_.size() && text_.substr(place).starts_with(signature);
    }

  private:
    std::string_view text_;
};

/// Where the list of members begins, and how many there are.
struct List {
    std::uint64_t place = 0, count = 0;
};

List find_list(std::string_view archive) {
    constexpr std::size_t end_size = 22, longest_comment = 65535, locator_size = 20;
    const auto from = archive.size() - std::min(archive.size(), end_size + longest_comment);
    const auto found = archive.substr(from).rfind(end_record);
    if (found == std::string_view::npos) no_archive();
    const auto end = from + found;
    const Bytes bytes(archive);
    bytes.part(end, end_size + bytes.at<std::uint16_t>(end + 20));  // with the comment behind it
    List list{bytes.at<std::uint32_t>(end + 16), bytes.at<std::uint16_t>(end + 10)};
    if (end >= locator_size && bytes.begins(end - locator_size, zip64_locator)) {
        const auto place = bytes.at<std::uint64_t>(end - locator_size + 8);
        if (!bytes.begins(place, zip64_end)) no_archive();
        list = {bytes.at<std::uint64_t>(place + 48), bytes.at<std::uint64_t>(place + 32)};
    }
    return list;
}

/// Puts what the extra field 1 of an entry tells in the place of numbers that do not fit into 32 bits, in their order.
void take_zip64(std::string_view extra, std::uint64_t& size, std::uint64_t& packed, std::uint64_t& offset) {
    for (Bytes fields(extra); extra.size() >= 4; fields = Bytes(extra)) {
        const auto kind = fields.at<std::uint16_t>(0), length = fields.at<std::uint16_t>(2);
        const Bytes field(fields.part(4, length));
        std::uint64_t at = 0;
        if (kind == 1)
            for (auto* number : {&size, &packed, &offset})
                if (*number == in_zip64) *number = field.at<std::uint64_t>(std::exchange(at, at + 8));
        extra.remove_prefix(4 + std::size_t{length});
    }
}

/// The entry of the list at `place`, which moves behind it.
ZipMember read_entry(const Bytes& archive, std::uint64_t& place) {
    if (!archive.begins(place, list_entry)) no_archive();
    const auto flags = archive.at<std::uint16_t>(place + 8), method = archive.at<std::uint16_t>(place + 10);
    const auto name_length = archive.at<std::uint16_t>(place + 28),
               extra_length = archive.at<std::uint16_t>(place + 30),
               comment_length = archive.at<std::uint16_t>(place + 32);
    ZipMember member;
    member.name = archive.part(place + 46, name_length);
    member.deflated = method == Z_DEFLATED;
    member.checksum = archive.at<std::uint32_t>(place + 16);
    member.size = archive.at<std::uint32_t>(place + 24);
    std::uint64_t packed = archive.at<std::uint32_t>(place + 20),
                  offset = archive.at<std::uint32_t>(place + 42);
    take_zip64(archive.part(place + 46 + name_length, extra_length), member.size, packed, offset);
    place += 46 + std::uint64_t{name_length} + extra_length + comment_length;
    const auto fail = [&](const std::string& what) { throw Error("{}: {}", in_quotes(member.name), what); };
    if (flags & 1) fail("encrypted");
    if (method != 0 && method != Z_DEFLATED)
        fail(fmt::format("compressed by method {}, which is not read", method));
    if (!archive.begins(offset, local_header)) fail("it is not where the archive's list says: damaged");
    const auto before =
        30 + std::uint64_t{archive.at<std::uint16_t>(offset + 26)} + archive.at<std::uint16_t>(offset + 28);
    member.stored = archive.part(offset + before, packed);
    if (!member.deflated && member.size != packed) fail("its sizes contradict one another: damaged");
    return member;
}

void check_sum(const ZipMember& member, std::string_view text) {
    auto sum = crc32(0, nullptr, 0);
    for (std::size_t from = 0; from < text.size(); from += std::numeric_limits<uInt>::max()) {
        const auto piece = text.substr(from, std::numeric_limits<uInt>::max());
        sum = crc32(sum, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size()));
    }
    if (text.size() != member.size || sum != member.checksum) throw Error("its checksum is wrong: damaged");
}

/// The deflated text up to `most` bytes.
std::string_view inflated(const ZipMember& member, std::vector<char>& memory, std::uint64_t most) {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw Error("no memory to decompress it");
    const std::unique_ptr<z_stream, decltype(&inflateEnd)> ends(&stream, &inflateEnd);
    auto left = member.stored;
    std::size_t filled = 0;
    int result = Z_OK;
    while (result != Z_STREAM_END && filled < most) {
        const auto room = std::min<std::uint64_t>(most, std::max<std::uint64_t>(2 * filled, first_room));
        if (memory.size() < room) memory.resize(room);
        const auto in =
            static_cast<uInt>(std::min<std::size_t>(left.size(), std::numeric_limits<uInt>::max()));
        const auto out =
            static_cast<uInt>(std::min<std::size_t>(room - filled, std::numeric_limits<uInt>::max()));
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(left.data()));
        stream.avail_in = in;
        stream.next_out = reinterpret_cast<Bytef*>(memory.data() + filled);
        stream.avail_out = out;
        result = inflate(&stream, Z_NO_FLUSH);
        left.remove_prefix(in - stream.avail_in);
        filled += out - stream.avail_out;
        if (result != Z_OK && result != Z_STREAM_END) throw Error("it cannot be decompressed: damaged");
    }
    return {memory.data(), filled};
}

}  // namespace

std::vector<ZipMember> zip_members(std::string_view archive) {
    const auto list = find_list(archive);
    const Bytes bytes(archive);
    std::vector<ZipMember> members;
    auto place = list.place;
    for (std::uint64_t i = 0; i < list.count; ++i) members.push_back(read_entry(bytes, place));
    return members;
}

std::string_view zip_text(const ZipMember& member, std::vector<char>& memory, std::uint64_t most) {
    const auto text = member.deflated ? inflated(member, memory, most) : member.stored.substr(0, most);
    if (text.size() < most || text.size() == member.size) check_sum(member, text);
    return text;
}

}  // namespace actformer
