#include "ingest/synth/folder.hpp"

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/loose_json.hpp"
#include "ingest/dataset/origin.hpp"

namespace actformer::ingest::synth {

namespace fs = std::filesystem;

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
    const auto file = folder / "synth.json";
    nlohmann::ordered_json mine = {{"made_by", made_by}, {"version", ACTFORMER_VERSION}, {"seed", seed}};
    if (clips) mine["clips"] = *clips;
    const bool is_new = !fs::exists(file);
    const auto said = loose::read(file);
    if (!is_new && (said.is_discarded() || said != mine))  // what is no JSON is unequal to nothing
        throw Error(
            "{}: the folder holds clips of another seed{} or version than seed {}{} of version {}; choose "
            "another with -o",
            file.string(), clips ? ", number" : "", seed, clips ? fmt::format(" and {} clips", *clips) : "",
            ACTFORMER_VERSION);
    write_origin(folder, DataOrigin::Kind::stand_in);
    if (is_new) write_file(file, mine.dump(2) + "\n");
}

}  // namespace actformer::ingest::synth
