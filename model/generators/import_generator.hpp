// Released checkpoints of the methods, as weights that `generate` takes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace actformer::model {

struct ImportGeneratorRequest {
    std::filesystem::path file;  ///< of torch.save
    std::filesystem::path data;  ///< dataset whose skeleton, representation and classes its motions have
    std::filesystem::path out;   ///< weights to make
    std::vector<std::string> overrides;  ///< of settings that no checkpoint tells, key=value
};

struct ImportedGenerator {
    std::string method, title;
    std::uint64_t numbers = 0;  ///< in all weights
    std::uint32_t classes = 0;
};

/// Which method's it is its weights' names tell. Throws Error, one line, for a file that cannot be read (see read_torch_arrays), of no
/// method known, of a variant, and for one of other sizes, classes or another representation than the dataset's. The file appears whole
/// or not at all.
ImportedGenerator import_generator(const ImportGeneratorRequest& request);

}  // namespace actformer::model
