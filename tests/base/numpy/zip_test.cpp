// Zip archives made byte by byte, sound and damaged.
#include "base/numpy/zip.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include "base/error.hpp"
#include "tests/support/zip_parts.hpp"

using namespace actformer;
using actformer::test::deflate_raw, actformer::test::number;

namespace {

/// An archive of one member `a` with this text, and what may be odd about it.
struct Made {
    std::string text = "some text, some text, some text";
    int method = 0, flags = 0;
    bool zip64 = false;
    std::uint64_t offset = 0, claimed_size = 0;  ///< 0: as it is
    std::string comment{};

    std::string bytes() const {
        const auto packed = method == Z_DEFLATED ? deflate_raw(text) : text;
        const auto sum =
            number(crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size())), 4);
        const auto size = claimed_size ? claimed_size : text.size();
        const std::string local_extra =
            number(1, 2) + number(16, 2) + std::string(16, '\0');  // as NumPy writes them
        auto out = std::string("PK\x03\x04") + number(45, 2) + number(flags, 2) + number(method, 2) +
                   number(0, 4) + sum + number(0xFFFFFFFF, 4) + number(0xFFFFFFFF, 4) + number(1, 2) +
                   number(20, 2) + "a" + local_extra + packed;
        const auto list = out.size();
        const auto numbers = zip64 ? number(1, 2) + number(24, 2) + number(size, 8) +
                                         number(packed.size(), 8) + number(offset, 8)
                                   : std::string();
        const auto field = [&](std::uint64_t value) { return number(zip64 ? 0xFFFFFFFF : value, 4); };
        out += std::string("PK\x01\x02") + number(45, 2) + number(45, 2) + number(flags, 2) +
               number(method, 2) + number(0, 4) + sum + field(packed.size()) + field(size) + number(1, 2) +
               number(numbers.size(), 2) + number(0, 2) + number(0, 8) + field(offset) + "a" + numbers;
        const auto after = out.size();
        if (zip64)
            out += std::string("PK\x06\x06") + number(44, 8) + number(45, 2) + number(45, 2) + number(0, 8) +
                   number(1, 8) + number(1, 8) + number(after - list, 8) + number(list, 8) +
                   std::string("PK\x06\x07") + number(0, 4) + number(after, 8) + number(1, 4);
        return out + std::string("PK\x05\x06") + number(0, 4) + number(zip64 ? 0xFFFF : 1, 2) +
               number(zip64 ? 0xFFFF : 1, 2) + field(after - list) + field(list) + number(comment.size(), 2) +
               comment;
    }
};

std::string read(const std::string& bytes, std::uint64_t most = 1 << 20) {
    try {
        std::string out;
        std::vector<char> memory;
        for (const auto& member : zip_members(bytes))
            out += member.name + "=" + std::string(zip_text(member, memory, most));
        return out;
    } catch (const Error& e) {
        return e.what();
    }
}

}  // namespace

TEST(Zip, ReadsStoredAndDeflatedMembers) {
    for (const bool zip64 : {false, true})
        for (const int method : {0, Z_DEFLATED}) {
            Made made{.method = method, .zip64 = zip64};
            EXPECT_EQ(read(made.bytes()), "a=" + made.text) << zip64 << method;
            made.comment = "with a comment";
            EXPECT_EQ(read(made.bytes()), "a=" + made.text);
            EXPECT_EQ(read(made.bytes(), 4), "a=some");
            made.text = "";
            EXPECT_EQ(read(made.bytes()), "a=");
            made.text.assign(300000, 'x');  // beyond the first room
            EXPECT_EQ(read(made.bytes()), "a=" + made.text);
        }
    EXPECT_EQ(read(std::string("PK\x05\x06") + std::string(18, '\0')), "");
}

TEST(Zip, StoredTextIsReadWhereItLies) {
    const auto bytes = Made{}.bytes();
    std::vector<char> memory;
    const auto members = zip_members(bytes);
    const auto text = zip_text(members.at(0), memory, 1 << 20);
    EXPECT_TRUE(text.data() > bytes.data() && text.data() < bytes.data() + bytes.size());
    EXPECT_TRUE(memory.empty());
}

TEST(Zip, SaysWhatIsDamaged) {
    EXPECT_EQ(read(""), "no zip archive, or cut short");
    EXPECT_EQ(read(Made{.flags = 1}.bytes()), "'a': encrypted");
    EXPECT_EQ(read(Made{.method = 12}.bytes()), "'a': compressed by method 12, which is not read");
    EXPECT_EQ(read(Made{.offset = 7}.bytes()), "'a': it is not where the archive's list says: damaged");
    EXPECT_EQ(read(Made{.zip64 = true, .offset = ~std::uint64_t{0} - 20}.bytes()),
              "'a': it is not where the archive's list says: damaged");
    EXPECT_EQ(read(Made{.claimed_size = 5}.bytes()), "'a': its sizes contradict one another: damaged");
    EXPECT_EQ(read(Made{.method = Z_DEFLATED, .claimed_size = 5}.bytes()), "its checksum is wrong: damaged");
    for (const bool zip64 : {false, true})
        for (const int method : {0, Z_DEFLATED}) {
            const auto sound = Made{.method = method, .zip64 = zip64}.bytes();
            for (std::size_t cut = 0; cut < sound.size(); ++cut)
                EXPECT_NE(read(sound.substr(0, cut)), read(sound)) << cut;
            auto changed = sound;
            changed[30 + 1 + 20 + 9] ^= 1;  // within the text
            EXPECT_NE(read(changed).find("damaged"), std::string::npos) << method;
        }
}
