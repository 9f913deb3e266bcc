// Released weights of recognisers, as weights that `features` and `score` take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace actformer::model {

struct ImportRecogniserRequest {
    std::filesystem::path file;  ///< of torch.save
    std::filesystem::path data;  ///< dataset whose skeleton, representation and classes its motions have
    std::filesystem::path out;   ///< weights to make
};

struct ImportedRecogniser {
    std::string kind;  ///< "stgcn" or "gru"
    std::uint64_t numbers = 0;
    std::uint32_t classes = 0;
};

/// An ST-GCN (Yan et al. 2018) or Action2Motion's GRU classifier (Guo et al. 2020), whichever the weights' names tell. Throws Error, one
/// line, for a file that cannot be read (see read_torch_arrays), of neither, and for one of other sizes or classes than the dataset's.
/// The file appears whole or not at all.
ImportedRecogniser import_recogniser(const ImportRecogniserRequest& request);

}  // namespace actformer::model
