#include "model/train/tensorboard.hpp"

#include <bit>
#include <boost/crc.hpp>
#include <cstdint>
#include <set>
#include <string_view>

namespace actformer::model {
namespace {

/// Numbers of a log's line that are no measures.
const std::set<std::string, std::less<>> counts{"epoch", "step", "seconds"};

template <typename Number>
std::string little_endian(Number number) {
    std::string out;
    for (std::size_t i = 0; i < sizeof number; ++i) out += static_cast<char>(number >> (8 * i) & 0xff);
    return out;
}

// Protocol buffers: a field begins with its number and its kind.
enum Kind : std::uint8_t { varint = 0, eight_bytes = 1, bytes = 2, four_bytes = 5 };

std::string as_varint(std::uint64_t number) {
    std::string out;
    for (; number >= 128; number >>= 7) out += static_cast<char>(number | 128);
    return out + static_cast<char>(number);
}

std::string key(unsigned field, Kind kind) {
    return as_varint(field << 3 | kind);
}

std::string text_field(unsigned field, std::string_view text) {
    return key(field, bytes) + as_varint(text.size()) + std::string(text);
}

/// CRC-32C, turned and shifted so that a checksum of bytes that hold checksums is none of its own.
std::uint32_t masked_checksum(std::string_view of) {
    boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> sum;
    sum.process_bytes(of.data(), of.size());
    return std::rotr(static_cast<std::uint32_t>(sum.checksum()), 15) + 0xa282ead8U;
}

std::string record(const std::string& message) {
    const auto length = little_endian(std::uint64_t{message.size()});
    return length + little_endian(masked_checksum(length)) + message +
           little_endian(masked_checksum(message));
}

std::string time_field(double time) {
    return key(1, eight_bytes) + little_endian(std::bit_cast<std::uint64_t>(time));
}

}  // namespace

std::string tensorboard_head(double time) {
    return record(time_field(time) + text_field(3, "brain.Event:2"));
}

std::string tensorboard_event(const nlohmann::ordered_json& line, double time) {
    const auto step = line.find("step");
    if (step == line.end() || !step->is_number_integer()) return {};
    std::string summary;
    for (const auto& [name, value] : line.items())
        if (value.is_number() && !counts.contains(name)) {
            const auto number = std::bit_cast<std::uint32_t>(value.get<float>());
            summary += text_field(1, text_field(1, name) + key(2, four_bytes) + little_endian(number));
        }
    if (summary.empty()) return {};
    return record(time_field(time) + key(2, varint) + as_varint(step->get<std::uint64_t>()) +
                  text_field(5, summary));
}

}  // namespace actformer::model
