#include "base/hdf5/attribute_bytes.hpp"

#include <vector>

#include "base/hdf5/little_endian.hpp"

namespace actformer::hdf5 {
namespace {

constexpr unsigned attribute_message = 0x0C, continuation_message = 0x10;
constexpr std::size_t most_blocks = 64;

/// Messages one behind the other.
struct HeaderBlock {
    std::uint64_t at, size;
};

/// Where the first block lies, and how its messages and those of further blocks begin.
struct HeaderForm {
    HeaderBlock first;
    std::size_t before;  ///< bytes of a message before its contents
    bool newer;          ///< version 2
};

std::optional<HeaderForm> form_of(std::uint64_t address, const FileBytes& file) {
    constexpr std::size_t longest = 40;
    const auto start = file(address, longest);
    if (start.size() < longest) return {};
    if (start[0] == 1) return HeaderForm{{address + 16, number_in<std::uint32_t>(start, 8)}, 8, false};
    if (!start.starts_with("OHDR\2")) return {};
    const unsigned flags = static_cast<unsigned char>(start[5]), width = 1U << (flags & 3);
    const std::size_t at = 6 + (flags & 0x20 ? 16 : 0) + (flags & 0x10 ? 4 : 0);
    const auto bits = number_in<std::uint64_t>(start, at);
    const auto size = width == 8 ? bits : bits & ((std::uint64_t{1} << 8 * width) - 1);
    return HeaderForm{{address + at + width, size}, flags & 4 ? std::size_t{6} : 4, true};
}

/// The attribute's bytes, where the message is about it.
std::optional<std::string> bytes_in(std::string_view message, const std::string& name) {
    if (message.size() < 9) return {};
    const int version = message[0];
    const auto place = [&](std::size_t at) {
        const std::size_t size = number_in<std::uint16_t>(message, at);
        return version == 1 ? (size + 7) / 8 * 8 : size;
    };
    const std::size_t begin = version == 3 ? 9 : 8, behind = begin + place(2) + place(4) + place(6);
    if (behind > message.size()) return {};
    const auto called = message.substr(begin, number_in<std::uint16_t>(message, 2));
    if (called.substr(0, called.find('\0')) != name) return {};
    return std::string(message.substr(behind));
}

/// Where further messages lie, as the contents of a message tell.
HeaderBlock block_told_by(std::string_view message, bool newer) {
    const auto at = number_in<std::uint64_t>(message, 0), size = number_in<std::uint64_t>(message, 8);
    if (!newer) return {at, size};
    constexpr std::uint64_t name = 4, checksum = 4;
    return {at + name, size < name + checksum ? 0 : size - name - checksum};
}

}  // namespace

std::optional<std::string> attribute_bytes(std::uint64_t address, const std::string& name,
                                           const FileBytes& file) {
    const auto form = form_of(address, file);
    if (!form) return {};
    std::vector<HeaderBlock> blocks{form->first};
    for (std::size_t i = 0; i < blocks.size() && i < most_blocks; ++i) {
        const auto bytes = file(blocks[i].at, blocks[i].size);
        for (std::size_t at = 0; at + form->before <= bytes.size();) {
            const unsigned type = static_cast<unsigned char>(bytes[at]);  // none goes beyond a byte
            const auto size = number_in<std::uint16_t>(bytes, at + (form->newer ? 1 : 2));
            at += form->before;
            if (size > bytes.size() - at) break;
            const auto message = std::string_view(bytes).substr(at, size);
            at += size;
            if (type == continuation_message && size >= 16)
                blocks.push_back(block_told_by(message, form->newer));
            if (type != attribute_message) continue;
            if (auto found = bytes_in(message, name)) return found;
        }
    }
    return {};
}

}  // namespace actformer::hdf5
