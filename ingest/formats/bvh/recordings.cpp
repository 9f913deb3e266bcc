#include "ingest/formats/bvh/recordings.hpp"

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "ingest/formats/asf/amc_file.hpp"
#include "ingest/formats/bvh/bvh_file.hpp"
#include "ingest/formats/clip_names.hpp"

namespace actformer::ingest {
namespace {

constexpr std::uint64_t largest_asf = std::uint64_t{16} << 20;

/// Up to the last /, which is part of it.
std::string folder_of(const std::string& path) {
    return path.substr(0, path.find_last_of('/') + 1);
}

/// "35" of "35_01".
std::string subject_of(const std::string& path) {
    const auto end = path.find_last_of("_/");
    return end == std::string::npos || path[end] == '/' ? path : path.substr(0, end);
}

}  // namespace

Recordings::Recordings(const std::string& asf) {
    if (asf.empty()) return;
    std::vector<char> scratch;
    given_ = parse_asf(read_text(asf, scratch, largest_asf));
    if (const auto* rejection = std::get_if<Rejection>(&*given_))
        throw Error("{}: {}", asf, rejection->reason);
}

bool Recordings::is_asf(const RawText& raw) {
    return raw.ends_in(".asf");
}

bool Recordings::is_amc(const RawText& raw) {
    return raw.ends_in(".amc");
}

void Recordings::add_asf(const RawText& raw) {
    by_path_.emplace(path_for_names(raw), parse_asf(raw.text));
}

const Recordings::Parsed* Recordings::own_asf(const std::string& path) const {
    for (const auto& name : {path, subject_of(path)})
        if (const auto found = by_path_.find(name); found != by_path_.end()) return &found->second;
    return nullptr;
}

bool Recordings::has_own_asf(const RawText& amc) const {
    return own_asf(path_for_names(amc)) != nullptr;
}

const Recordings::Parsed* Recordings::asf_of(const std::string& path) const {
    if (const auto* own = own_asf(path)) return own;
    if (given_) return &*given_;
    const Parsed* only = nullptr;
    const auto folder = folder_of(path);
    for (auto it = by_path_.lower_bound(folder); it != by_path_.end() && it->first.starts_with(folder);
         ++it) {
        if (folder_of(it->first) != folder) continue;
        if (only) return nullptr;
        only = &it->second;
    }
    return only;
}

std::variant<std::vector<Recording>, Rejection> Recordings::read(const RawText& raw) const {
    if (!is_amc(raw)) return parse_bvh(raw.text);
    const auto path = path_for_names(raw);
    const Parsed* asf = asf_of(path);
    const auto name = subject_of(path).substr(folder_of(path).size()) + ".asf";
    if (!asf)
        return Rejection{Rejection::Kind::broken,
                         fmt::format("no skeleton {} beside it; --asf FILE gives one", name)};
    if (const auto* rejection = std::get_if<Rejection>(asf))
        return Rejection{Rejection::Kind::broken,
                         fmt::format("its skeleton, {}, is at fault: {}", name, rejection->reason)};
    auto parsed = parse_amc(raw.text, std::get<AsfSkeleton>(*asf));
    if (auto* rejection = std::get_if<Rejection>(&parsed)) return std::move(*rejection);
    std::vector<Recording> persons;
    persons.push_back(std::get<Recording>(std::move(parsed)));
    return persons;
}

}  // namespace actformer::ingest
