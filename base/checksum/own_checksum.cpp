#include "base/checksum/own_checksum.hpp"

#include <algorithm>
#include <fstream>

#include "base/error.hpp"
#include "base/files/file.hpp"

namespace actformer {
namespace {

constexpr std::string_view before_digits = "\nchecksum ";
constexpr std::size_t digits = 32, line_size = before_digits.size() + digits + 1;

bool is_digit(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

/// The beginning of such a line, where the file was cut in it.
bool ends_in_cut_line(std::string_view end) {
    const auto at = end.rfind(before_digits);
    return at != end.npos && std::ranges::all_of(end.substr(at + before_digits.size()), is_digit);
}

/// A line with a few wrong characters is still one, and damaged. So is one that was cut.
bool is_checksum_line(std::string_view line) {
    constexpr int most_wrong = 4;
    if (ends_in_cut_line(line)) return true;
    if (line.size() != line_size) return false;
    auto wrong = digits - std::ranges::count_if(line.substr(before_digits.size(), digits), is_digit);
    for (std::size_t i = 0; i < before_digits.size(); ++i) wrong += line[i] != before_digits[i];
    wrong += line.back() != '\n';
    return wrong <= most_wrong;
}

std::string line_of(const std::string& hex) {
    return std::string(before_digits) + hex + "\n";
}

std::uint64_t size_of(const std::filesystem::path& path) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (error) throw Error("{}: cannot be read: {}", path.string(), error.message());
    return size;
}

/// The file's last bytes, as many as such a line has; fewer of a shorter file.
std::string end_of(const std::filesystem::path& path, std::uint64_t size) {
    std::string end(std::min<std::uint64_t>(size, line_size), '\0');
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(size - end.size()));
    if (!file.read(end.data(), static_cast<std::streamsize>(end.size())))
        throw Error("{}: cannot be read", path.string());
    return end;
}

}  // namespace

std::string checksum_line(std::string_view bytes) {
    return line_of(checksum(bytes));
}

std::string checksum_line_of(const Checksum& bytes) {
    return line_of(bytes.hex());
}

bool names_this_program(std::string_view program) {
    constexpr std::string_view name = "actformer ";
    return program.size() > name.size() && program.starts_with(name) && program[name.size()] >= '0' &&
           program[name.size()] <= '9';
}

bool has_checksum_line(std::string_view bytes) {
    return is_checksum_line(bytes.substr(bytes.size() - std::min(bytes.size(), line_size)));
}

bool has_checksum_line(const std::filesystem::path& path) {
    return is_checksum_line(end_of(path, size_of(path)));
}

OwnChecksum own_checksum(std::string_view bytes) {
    const auto before = bytes.substr(0, bytes.size() - std::min(bytes.size(), line_size));
    const auto line = bytes.substr(before.size());
    if (!is_checksum_line(line)) return OwnChecksum::absent;
    return line == checksum_line(before) ? OwnChecksum::right : OwnChecksum::wrong;
}

OwnChecksum own_checksum_of_file(const std::filesystem::path& path) {
    const auto size = size_of(path);
    const auto line = end_of(path, size);
    if (!is_checksum_line(line)) return OwnChecksum::absent;
    Checksum sum;
    auto left = size - line_size;
    read_in_pieces(path, [&](std::string_view piece) {
        sum.add(piece.substr(0, left));
        left -= std::min<std::uint64_t>(left, piece.size());
    });
    return line == line_of(sum.hex()) ? OwnChecksum::right : OwnChecksum::wrong;
}

}  // namespace actformer
