#include "ingest/pipeline/empty_classes.hpp"

#include <cstring>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/hdf5/reader.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

constexpr auto column = "clip/label";

/// The shard's bytes with `renumbered[label]` in place of every label.
std::string_view renumber(const fs::path& path, const std::vector<std::uint32_t>& renumbered,
                          std::vector<char>& scratch) {
    const hdf5::Reader file(path);
    auto labels = file.read<std::uint32_t>(column);
    const auto offset = file.offset(column);
    const auto image = read_text(path, scratch, std::uint64_t{1} << 40);
    if (!offset || *offset + labels.size() * sizeof labels[0] > image.size())
        throw Error("{}: its labels are not where they were written; ingest the raw data again",
                    path.string());
    for (auto& label : labels) label = renumbered.at(label);
    std::memcpy(scratch.data() + *offset, labels.data(), labels.size() * sizeof labels[0]);
    return image;
}

}  // namespace

std::vector<std::string> drop_empty_classes(
    DatasetFile& file, const std::set<std::uint32_t>& labels, const fs::path& folder,
    const std::function<void(const std::map<fs::path, std::string>&)>& announce) {
    std::vector<std::string> kept, dropped;
    std::vector<std::uint32_t> renumbered;
    for (std::uint32_t label = 0; label < file.header.classes.size(); ++label) {
        renumbered.push_back(static_cast<std::uint32_t>(kept.size()));
        (labels.contains(label) ? kept : dropped).push_back(file.header.classes[label]);
    }
    if (dropped.empty()) return {};
    std::vector<char> scratch;
    std::map<fs::path, std::string> to_be;
    for (const auto& shard : file.shards)
        if (const auto path = folder / shard.file; hdf5::Reader(path).contents() == shard.checksum)
            to_be[path] = checksum(renumber(path, renumbered, scratch));
    announce(to_be);
    for (auto& shard : file.shards) {
        const auto path = folder / shard.file;
        if (to_be.contains(path)) write_whole(path, renumber(path, renumbered, scratch), Sync::later);
        const hdf5::Reader now(path);
        shard.checksum = now.contents();
        shard.metadata = now.metadata("motion");
    }
    file.header.classes = std::move(kept);
    return dropped;
}

}  // namespace actformer::ingest
