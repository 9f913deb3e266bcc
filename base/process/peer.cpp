#include "base/process/peer.hpp"

#include <array>
#include <cstdio>

namespace actformer {

std::optional<std::string> output_of(const std::string& line) {
    FILE* pipe = ::popen(line.c_str(), "r");
    if (!pipe) return {};
    std::string said;
    std::array<char, 4096> piece;
    while (const auto got = std::fread(piece.data(), 1, piece.size(), pipe)) said.append(piece.data(), got);
    if (::pclose(pipe) != 0) return {};
    return said;
}

}  // namespace actformer
