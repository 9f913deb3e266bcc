// PoCL has no device where it cannot write the programs that it has compiled.
#pragma once

#include <filesystem>

namespace actformer::kernels {

/// The folder of PoCL's cache, where PoCL is installed and cannot write there; else empty. The folder is made, as PoCL does.
std::filesystem::path unwritable_pocl_cache();

}  // namespace actformer::kernels
