// A table of labels beside raw files, for names that do not tell the action: a CSV or TSV file with a header line.
//
//   file,action,subject,start_frame,end_frame        file (or name): a path or a name, with or without its extension
//   hips31/02/02_01.bvh,walk,2,1,344                 action (or label, or class): the class
//   hips31/02/02_05.bvh,punch,2,1,927                start_frame, end_frame: of the file's frames, from 0, the end not among them;
//   hips31/02/02_05.bvh,strike,2,927,1855            empty: to the file's ends. Several rows make several clips of a file.
//                                                    every other column: a field of the clip, for splits
//
// Blanks around a value are left out, unless they stand in its quotes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace actformer::ingest {

struct LabelRow {
    std::string file;  ///< as it is written there
    std::string action;
    std::optional<std::uint32_t> start, end;  ///< frames
    std::vector<std::string> fields;          ///< as LabelsFile::fields() names them
};

class LabelsFile {
  public:
    /// Throws Error naming the file, the line and the remedy.
    explicit LabelsFile(const std::filesystem::path& path);
    LabelsFile(std::string_view text, const std::string& where);

    const std::vector<LabelRow>& rows() const { return rows_; }
    const std::vector<std::string>& fields() const {
        return fields_;
    }  ///< action first, then the other columns

    /// Indices of the rows for `path`, a file's path with or without extension: those whose own path is the end of it, and of these
    /// the longest path alone. Empty where there is none.
    std::vector<std::size_t> find(std::string_view path) const;

  private:
    void read(std::string_view text, const std::string& where);

    std::vector<LabelRow> rows_;
    std::vector<std::string> fields_;
    std::unordered_map<std::string, std::vector<std::size_t>> by_path_;  ///< a row's path -> rows
    std::size_t longest_path_ = 0;                                       ///< bytes, of a row's
};

}  // namespace actformer::ingest
