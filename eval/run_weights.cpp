#include "eval/run_weights.hpp"

#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "base/process/shipped.hpp"
#include "ingest/dataset/own_kind.hpp"

namespace actformer::eval {

std::filesystem::path weights_of(const std::filesystem::path& named) {
    const auto run = here_or_shipped(named);
    std::error_code ignored;
    if (!std::filesystem::exists(run, ignored)) {
        auto meant = did_you_mean(run);
        if (const auto shipped = shipped_folder();
            meant.empty() && !shipped.empty() && run.is_relative() && run.has_parent_path())
            meant = did_you_mean(shipped / run);
        throw Error("{}: no such file or folder{}", run.string(), meant);
    }
    if (!std::filesystem::is_directory(run, ignored)) return run;
    for (const auto* name : {"weights-best.h5", "weights-average.h5", "weights-last.h5"})
        if (std::filesystem::exists(run / name, ignored)) return run / name;
    if (const auto kind = ingest::other_kind(run, ingest::own::training); !kind.empty())
        throw Error("{}: {}; a training or weights (.h5) are expected", run.string(), kind);
    throw Error("{}: holds no weights-*.h5; is it the folder of a training that has done an epoch?",
                run.string());
}

}  // namespace actformer::eval
