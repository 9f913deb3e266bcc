// Archives and compressed files that lie among the files of a folder. Their contents are not read, and the user is told.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

/// Whether a file has the name of an archive or of a compressed file.
bool is_packed(std::string_view path);

/// Remarks on packed files below `folder`, a line on archives and one on compressed files, as in
/// "2 archives in raw are not read (S002.tar.gz, S003.zip): unless unpacked there, give them as RAW too". `paths` are relative to the folder.
std::vector<std::string> remarks_on_packed(const std::filesystem::path& folder,
                                           std::vector<std::string> paths);

}  // namespace actformer::ingest
