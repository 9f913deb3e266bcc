#include "ingest/synth/ntu/skeleton_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace actformer::ingest::synth {
namespace {

constexpr std::string_view line_end = "\r\n";

constexpr std::array<double, 16> powers = {1,   1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                           1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

template <typename Integer>
char* put_integer(char* at, Integer value) {
    return std::to_chars(at, at + 24, value).ptr;
}

/// Seven significant digits. Much faster than std::to_chars with a precision, which is exact for any double.
char* put(char* at, double value) {
    if (!(std::abs(value) >= 1e-7)) {  // next to nothing, and what is no number
        *at = '0';
        return at + 1;
    }
    if (value < 0) {
        *at++ = '-';
        value = -value;
    }
    int exponent = 0;  // value is in [10^exponent, 10^(exponent + 1))
    if (value >= 1)
        while (value >= powers[exponent + 1]) ++exponent;
    else
        while (value * powers[-exponent] < 1) --exponent;
    const int decimals = 6 - exponent;
    auto digits = static_cast<std::uint64_t>(value * powers[std::max(0, decimals)] + 0.5);
    const auto one = static_cast<std::uint64_t>(powers[std::max(0, decimals)]);
    at = put_integer(at, digits / one);
    digits %= one;
    if (digits == 0) return at;
    *at++ = '.';
    for (int i = decimals - 1; i >= 0; --i) {
        at[i] = static_cast<char>('0' + digits % 10);
        digits /= 10;
    }
    at += decimals;
    while (at[-1] == '0') --at;
    return at;
}

char* field(char* at, double value) {
    at = put(at, value);
    *at++ = ' ';
    return at;
}

char* end_line(char* at) {
    return std::copy(line_end.begin(), line_end.end(), at);
}

/// Pinhole cameras: the depth image of 512 x 424 and the colour image of 1920 x 1080, the lens 7 cm beside
/// the other.
char* put_joint(char* at, const SeenJoint& j) {
    const double x = j.at.x / j.at.z, y = j.at.y / j.at.z;
    at = field(at, j.at.x);
    at = field(at, j.at.y);
    at = field(at, j.at.z);
    at = field(at, 366.5 * x + 256.1);
    at = field(at, 208.3 - 366.6 * y);
    at = field(at, 1055.8 * x + 955.3 + 75.9 / j.at.z);
    at = field(at, 567.3 - 1056.5 * y);
    at = field(at, j.orientation.w);
    at = field(at, j.orientation.x);
    at = field(at, j.orientation.y);
    at = field(at, j.orientation.z);
    *at++ = static_cast<char>('0' + static_cast<int>(j.tracking));
    return end_line(at);
}

char* put_body(char* at, const SeenBody& body) {
    at = put_integer(at, body.id);
    for (const int flag : body.flags) {
        *at++ = ' ';
        at = put_integer(at, flag);
    }
    *at++ = ' ';
    at = field(at, body.lean_x);
    at = field(at, body.lean_y);
    *at++ = '2';  // leaning is tracked
    at = end_line(at);
    at = end_line(put_integer(at, static_cast<int>(joints)));
    for (const auto& joint : body.joint) at = put_joint(at, joint);
    return at;
}

}  // namespace

void append_number(std::string& text, double value) {
    std::array<char, 40> buffer;
    text.append(buffer.data(), put(buffer.data(), value));
}

void write_skeleton(const Recording& recording, std::string& text) {
    constexpr std::size_t longest_body = 200 + joints * 160;  // characters
    std::size_t bodies = 0;
    for (const auto& frame : recording) bodies += frame.size();
    text.resize(32 + recording.size() * 16 + bodies * longest_body);
    char* at = text.data();
    at = end_line(put_integer(at, recording.size()));
    for (const auto& frame : recording) {
        at = end_line(put_integer(at, frame.size()));
        for (const auto& body : frame) at = put_body(at, body);
    }
    text.resize(static_cast<std::size_t>(at - text.data()));
}

}  // namespace actformer::ingest::synth
