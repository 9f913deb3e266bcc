// Files that come with the program: in the folder share/actformer beside it, or beside one of the two folders it lies in. They lie
// there as in the sources: model/configs/actformer.yaml.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace actformer {

/// Empty where nothing comes with this program.
std::filesystem::path shipped_folder();

/// `path` itself, or where nothing is there what comes with the program under it, as examples/cmu/cmu.tar.xz; itself where neither is.
std::filesystem::path here_or_shipped(const std::filesystem::path& path);

/// What a user calls `named`: that file where it is there, else one that comes with the program, called as it lies there or by its
/// name alone, its ending .yaml left out or not. `folder` is where such files lie, as in "model/configs". Throws Error with what may
/// have been meant where there is neither.
std::filesystem::path file_or_shipped(const std::filesystem::path& named, const std::string& folder);

/// Names of the files in `folder`, sorted, without .yaml.
std::vector<std::string> shipped_names(const std::string& folder);

}  // namespace actformer
