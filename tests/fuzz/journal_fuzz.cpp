// libFuzzer: each line as one of an ingest's journal, behind its right checksum unless it begins with `!`; those behind an empty line as
// announced shards. Work that is kept is kept again, and what does not fit is noted once.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/checksum/checksum.hpp"
#include "ingest/pipeline/journal.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;
namespace fs = std::filesystem;

namespace {

/// A working folder in memory, which goes with the program unless that crashes.
struct Folder {
    Folder() : path(path_in_memory("journal")) { fs::remove_all(path); }
    ~Folder() { fs::remove_all(path); }
    fs::path path;
};

void put(const fs::path& path, std::string_view bytes) {
    demand((std::ofstream(path, std::ios::binary) << bytes).flush().good());
}

/// The lines with their checksums, each of itself and all before it.
std::string journal_of(std::string_view lines, const std::string& request) {
    auto sum = checksum(request);
    auto out = sum + " " + request + "\n";
    while (!lines.empty()) {
        const std::string line(lines.substr(0, lines.find('\n')));
        lines.remove_prefix(std::min(lines.size(), line.size() + 1));
        sum = checksum(sum + line);
        out += line.starts_with('!') ? line + "\n" : sum + " " + line + "\n";
    }
    return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Folder folder;
    const std::string request = "ntu, as it was asked for";
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto empty = text.find("\n\n");
    fs::create_directories(folder.path / "data/one");
    put(folder.path / "data/one/shard-00000.h5", "abc");
    put(folder.path / "journal", journal_of(text.substr(0, empty), request));
    put(folder.path / "announced", empty == std::string_view::npos ? "" : text.substr(empty + 2));
    try_to([&] {
        std::size_t kept = 0;
        {
            const ingest::Workplace workplace(folder.path, request, 1);
            kept = workplace.finished().size();
            demand(workplace.notes().size() <= 1);
        }
        ingest::Workplace again(folder.path, request, 1);
        demand(again.finished().size() == kept && again.notes().empty());
        again.finish({});
    });
    return 0;
}
