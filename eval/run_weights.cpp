#include "eval/run_weights.hpp"

#include "base/error.hpp"
#include "base/process/shipped.hpp"

namespace actformer::eval {

std::filesystem::path weights_of(const std::filesystem::path& run) {
    std::error_code ignored;
    if (!std::filesystem::exists(run, ignored) && run.is_relative())
        if (auto shipped = shipped_folder() / run; std::filesystem::is_regular_file(shipped, ignored))
            return shipped;
    if (!std::filesystem::is_directory(run, ignored)) return run;
    for (const auto* name : {"weights-best.h5", "weights-average.h5", "weights-last.h5"})
        if (std::filesystem::exists(run / name, ignored)) return run / name;
    throw Error("{}: holds no weights-*.h5; is it the folder of a training that has done an epoch?",
                run.string());
}

}  // namespace actformer::eval
