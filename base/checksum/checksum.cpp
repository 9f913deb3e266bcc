#include "base/checksum/checksum.hpp"

#include <fmt/format.h>

// Inlined, so that it is compiled for this machine's widest vectors, as the installed library is not.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/files/file.hpp"

namespace actformer {
namespace {

std::string hex_of(XXH128_hash_t h) {
    return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

}  // namespace

struct Checksum::State {
    XXH3_state_t hash;
};

Checksum::Checksum() : state_(std::make_unique<State>()) {
    XXH3_128bits_reset(&state_->hash);
}
Checksum::~Checksum() = default;

Checksum& Checksum::add(std::string_view bytes) {
    XXH3_128bits_update(&state_->hash, bytes.data(), bytes.size());
    return *this;
}

std::string Checksum::hex() const {
    return hex_of(XXH3_128bits_digest(&state_->hash));
}

std::string checksum(std::string_view bytes) {
    return hex_of(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string checksum_file(const std::filesystem::path& path) {
    Checksum sum;
    read_in_pieces(path, [&](std::string_view piece) { sum.add(piece); });
    return sum.hex();
}

}  // namespace actformer
