// Clips to one .npz of joint positions.
//
//   CLIP       (T, P, K, 3) float32  metres; called as the clip, with an underscore and a number behind it where another array is
//   clips      (clips)      text     the names of these arrays, in their order
//   labels     (clips)      int64    index into `classes`, -1 where it is not known
//   classes    (classes)    text
//   names      (K)          text     of the joints
//   parents    (K)          int64    -1 for the root
//   fps        ()           float64
//   program, source  ()     text     what wrote it, and the fingerprint of what it comes from
#pragma once

#include "ingest/export/export_format.hpp"

namespace actformer::ingest {

/// Clips are written as they come.
std::unique_ptr<ExportFile> open_npz(const std::filesystem::path& path, const ExportContext& context);

}  // namespace actformer::ingest
