#include "ingest/export/npz/zip_writer.hpp"

#include <zlib.h>

#include <limits>

namespace actformer::ingest {
namespace {

constexpr std::uint64_t most32 = std::numeric_limits<std::uint32_t>::max(),
                        most16 = std::numeric_limits<std::uint16_t>::max();
constexpr int plain_version = 20, zip64_version = 45, utf8_names = 1 << 11;
constexpr int first_day = 1 << 5 | 1;  // 1980-01-01

/// Numbers as the format has them, the low byte first.
class Record {
  public:
    Record& u16(std::uint64_t v) { return number(v, 2); }
    Record& u32(std::uint64_t v) { return number(v, 4); }
    Record& u64(std::uint64_t v) { return number(v, 8); }
    Record& text(std::string_view t) {
        bytes_ += t;
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    Record& number(std::uint64_t v, int bytes) {
        for (; bytes > 0; --bytes, v >>= 8) bytes_ += static_cast<char>(v & 0xFF);
        return *this;
    }
    std::string bytes_;
};

/// Those of `values` that 32 bits do not hold, as an extra field.
std::string zip64_field(std::initializer_list<std::uint64_t> values) {
    Record large;
    for (const auto v : values)
        if (v >= most32) large.u64(v);
    if (large.bytes().empty()) return {};
    return Record().u16(1).u16(large.bytes().size()).text(large.bytes()).bytes();
}

std::uint64_t or_most(std::uint64_t value, std::uint64_t most) {
    return std::min(value, most);
}

}  // namespace

void ZipWriter::put(std::string_view bytes) {
    file_.write(bytes);
    at_ += bytes.size();
}

void ZipWriter::add(const std::string& name, std::span<const std::string_view> parts) {
    Member member{name, 0, 0, at_};
    auto checksum = crc32_z(0, nullptr, 0);
    for (const auto part : parts) {
        if (part.empty()) continue;  // zlib begins anew where it is given no memory
        checksum = crc32_z(checksum, reinterpret_cast<const Bytef*>(part.data()), part.size());
        member.size += part.size();
    }
    member.checksum = static_cast<std::uint32_t>(checksum);
    // In front of a member both sizes are given in 64 bits, or neither.
    const auto extra = member.size >= most32 ? zip64_field({member.size, member.size}) : "";
    Record head;
    head.u32(0x04034B50).u16(extra.empty() ? plain_version : zip64_version).u16(utf8_names).u16(0);
    head.u16(0).u16(first_day).u32(member.checksum);
    head.u32(or_most(member.size, most32)).u32(or_most(member.size, most32));
    head.u16(name.size()).u16(extra.size()).text(name).text(extra);
    put(head.bytes());
    for (const auto part : parts) put(part);
    members_.push_back(std::move(member));
}

void ZipWriter::finish() {
    const auto start = at_;
    for (const auto& m : members_) {
        const auto extra =
            m.size >= most32 ? zip64_field({m.size, m.size, m.offset}) : zip64_field({m.offset});
        const int version = extra.empty() ? plain_version : zip64_version;
        Record entry;
        entry.u32(0x02014B50).u16(version).u16(version).u16(utf8_names).u16(0).u16(0).u16(first_day);
        entry.u32(m.checksum).u32(or_most(m.size, most32)).u32(or_most(m.size, most32));
        entry.u16(m.name.size()).u16(extra.size()).u16(0).u16(0).u16(0).u32(0).u32(or_most(m.offset, most32));
        put(entry.text(m.name).text(extra).bytes());
    }
    const auto end = at_, size = end - start;
    const std::uint64_t count = members_.size();
    if (count >= most16 || size >= most32 || start >= most32) {
        Record record;
        record.u32(0x06064B50).u64(44).u16(zip64_version).u16(zip64_version).u32(0).u32(0);
        record.u64(count).u64(count).u64(size).u64(start);
        put(record.u32(0x07064B50).u32(0).u64(end).u32(1).bytes());
    }
    Record last;
    last.u32(0x06054B50).u16(0).u16(0).u16(or_most(count, most16)).u16(or_most(count, most16));
    put(last.u32(or_most(size, most32)).u32(or_most(start, most32)).u16(0).bytes());
    file_.commit();
}

}  // namespace actformer::ingest
