// What may have been meant by the path of a file that is not there.
#pragma once

#include <filesystem>
#include <string>

namespace actformer {

/// "; did you mean ntu/ntu-1p?": the entry of the same folder that is called most like `missing`. Where its folder is not there either, the
/// same of that folder: "; there is no ntv, did you mean ntu?". Empty where nothing is near.
std::string did_you_mean(const std::filesystem::path& missing);

}  // namespace actformer
