// Which weights a training's folder stands for.
#pragma once

#include <filesystem>

namespace actformer::eval {

/// Of a training's folder weights-best.h5, else weights-average.h5, else weights-last.h5; a file stands for itself, and
/// one that is not there for what comes with the program under that name, as weights/cmu/actformer.h5. Throws Error for a folder without any of
/// them, and where there is nothing, with what may have been meant.
std::filesystem::path weights_of(const std::filesystem::path& named);

}  // namespace actformer::eval
