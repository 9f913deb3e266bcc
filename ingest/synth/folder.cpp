#include "ingest/synth/folder.hpp"

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/work_folder.hpp"
#include "base/text/loose_json.hpp"
#include "ingest/dataset/origin.hpp"

namespace actformer::ingest::synth {

namespace fs = std::filesystem;
namespace {

constexpr const char *made_from = "synth.json", *origin = "ORIGIN";

/// A synth that was killed before it made a clip may have left these two.
bool is_of_a_start(const fs::path& below) {
    return is_called(below, made_from) || is_called(below, origin);
}

/// Throws Error where `folder`, in which no synth.json lies, holds a file or link: it would be replaced or taken for a stand-in.
void refuse_files_of_others(const fs::path& folder) {
    std::error_code error, ignored;
    for (fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error),
         end;
         !error && entry != end; entry.increment(error)) {
        const auto below = entry->path().lexically_relative(folder);
        const auto type = entry->symlink_status(ignored).type();
        if (type == fs::file_type::directory || (type == fs::file_type::regular && is_of_a_start(below)))
            continue;
        throw Error("{}: holds files that no synth left, as {}; choose another -o", folder.string(),
                    below.string());
    }
    if (error) throw Error("{}: cannot be read: {}; choose another -o", folder.string(), error.message());
}

/// False where nothing says what the folder's clips are. Throws Error where it is said that they are no stand-ins.
bool is_marked(const fs::path& folder) {
    const auto file = folder / origin;
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(file, ignored))) return false;
    std::optional<DataOrigin::Kind> said;
    try {
        said = read_origin(folder);
    } catch (const Error&) {  // none of an origin's names
    }
    if (said != DataOrigin::Kind::stand_in)
        throw Error("{}: does not say stand-in, as the clips of synth are; move it, or choose another -o",
                    file.string());
    return true;
}

}  // namespace

void write_file(const fs::path& file, std::string_view bytes) {
    try {
        make_folders(file.parent_path());
        write_whole(file, bytes, Sync::later);
    } catch (const std::exception& e) {
        throw Error("{}; run the command again: it goes on where it was", e.what());
    }
}

void claim_folder(const fs::path& folder, std::string_view made_by, std::uint64_t seed,
                  std::optional<std::uint64_t> clips) {
    make_folders(folder);
    const auto file = folder / made_from;
    nlohmann::ordered_json mine = {{"made_by", made_by}, {"version", ACTFORMER_VERSION}, {"seed", seed}};
    if (clips) mine["clips"] = *clips;
    const bool is_new = !fs::exists(file);
    if (is_new) refuse_files_of_others(folder);
    const auto said = loose::read(file);
    if (!is_new && (said.is_discarded() || said != mine))  // what is no JSON is unequal to nothing
        throw Error(
            "{}: the folder holds clips of another seed{} or version than seed {}{} of version {}; choose "
            "another with -o",
            file.string(), clips ? ", number" : "", seed, clips ? fmt::format(" and {} clips", *clips) : "",
            ACTFORMER_VERSION);
    const bool marked = is_marked(folder);
    if (is_new)
        write_file(file, mine.dump(2) + "\n");  // first: without it the folder is not taken for a synth's
    if (!marked) write_origin(folder, DataOrigin::Kind::stand_in);
}

}  // namespace actformer::ingest::synth
