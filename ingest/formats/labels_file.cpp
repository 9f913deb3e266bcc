#include "ingest/formats/labels_file.hpp"

#include <algorithm>
#include <charconv>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/lines.hpp"
#include "base/text/printable.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/formats/name_pattern.hpp"

namespace actformer::ingest {
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{1} << 30;

/// Records of comma-separated values, fields in quotes or not; a line break in quotes belongs to its field, blanks around it do
/// not.
class CsvReader {
  public:
    CsvReader(std::string_view text, const std::string& where) : text_(without_bom(text)), where_(where) {
        const auto header = text_.substr(0, text_.find('\n'));
        if (header.find('\t') != std::string_view::npos && header.find(',') == std::string_view::npos) {
            separator_ = '\t';
            ends_ = "\t\n";
        }
    }

    /// The next record that is not blank; false at the end.
    bool next(std::vector<std::string>& record) {
        do {
            if (text_.empty()) return false;
            record.clear();
            line_ = next_line_;
            while (read_field(record.emplace_back()))
                if (record.size() == most_fields)
                    throw Error("{}: more than {} columns; leave out what no split asks for", place(),
                                most_fields);
        } while (record.size() == 1 && record[0].empty());
        return true;
    }

    std::string place() const { return fmt::format("{}: line {}", where_, line_); }

  private:
    /// True where another field follows in the record.
    bool read_field(std::string& field) {
        skip_blanks();
        if (text_.starts_with('"')) {
            read_quoted(field);
            skip_blanks();
            if (!text_.empty() && text_[0] != separator_ && text_[0] != '\n' && text_[0] != '\r')
                throw Error("{}: text after the closing \" of {}", place(), in_quotes(field));
        }
        const auto end = std::min(text_.find_first_of(ends_), text_.size());
        auto plain = text_.substr(0, end);
        const bool more = end < text_.size() && text_[end] == separator_;
        if (plain.ends_with('\r') && !more) plain.remove_suffix(1);
        while (!plain.empty() && blank(plain.back())) plain.remove_suffix(1);
        field += plain;
        next_line_ += end < text_.size() && !more;
        text_.remove_prefix(std::min(end + 1, text_.size()));
        if (more && text_.empty()) text_ = "\n";  // an empty last field at the end of the text
        return more;
    }

    bool blank(char c) const { return c == ' ' || (c == '\t' && separator_ != '\t'); }
    void skip_blanks() {
        while (!text_.empty() && blank(text_[0])) text_.remove_prefix(1);
    }

    void read_quoted(std::string& field) {
        text_.remove_prefix(1);
        for (;;) {
            const auto quote = text_.find('"');
            if (quote == std::string_view::npos) throw Error("{}: a \" without its closing \"", place());
            field += text_.substr(0, quote);
            next_line_ += static_cast<std::size_t>(
                std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(quote), '\n'));
            text_.remove_prefix(quote + 1);
            if (!text_.starts_with('"')) return;
            field += '"';
            text_.remove_prefix(1);
        }
    }

    std::string_view text_;
    const std::string& where_;
    char separator_ = ',';
    const char* ends_ = ",\n";  ///< of a field
    std::size_t line_ = 0, next_line_ = 1;
};

/// Which column is what.
struct Columns {
    std::optional<std::size_t> file, action, start, end;
    std::vector<std::size_t> others;

    Columns(const std::vector<std::string>& header, const std::string& place) {
        for (std::size_t c = 0; c < header.size(); ++c) {
            if (std::count(header.begin(), header.end(), header[c]) > 1)
                throw Error("{}: two columns called {}", place, in_quotes(header[c]));
            if (!take(header[c], c)) others.push_back(c);
        }
        if (!action) take_class(header);
        if (!file || !action)
            throw Error(
                "{}: no column called {}; the first line names the columns, as in "
                "{},{},start_frame,end_frame",
                place, file ? "action, label or class" : "file, path, name or clip",
                file ? header[*file] : "file", action ? header[*action] : "action");
    }

  private:
    /// A column called class tells the action where none is called so: beside one it is a field.
    void take_class(const std::vector<std::string>& header) {
        const auto found =
            std::ranges::find(others, "class", [&](std::size_t column) { return header[column]; });
        if (found == others.end()) return;
        action = *found;
        others.erase(found);
    }

    bool take(const std::string& name, std::size_t column) {
        const auto take_as = [&](std::optional<std::size_t>& place, std::string_view a, std::string_view b) {
            if (place || (name != a && name != b)) return false;
            place = column;
            return true;
        };
        return take_as(file, "file", "path") || take_as(file, "name", "clip") ||
               take_as(action, "action", "label") || take_as(start, "start_frame", "start") ||
               take_as(end, "end_frame", "end");
    }
};

std::optional<std::uint32_t> frame_in(const std::string& text, const std::string& place) {
    if (text.empty()) return {};
    std::uint32_t frame = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), frame);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size())
        throw Error("{}: {} is no frame; give a whole number from 0, or nothing", place, in_quotes(text));
    return frame;
}

/// A row's, as find() looks for it.
std::string own_path(std::string_view file) {
    file = without_extension(file);
    while (file.starts_with("./")) file.remove_prefix(2);
    return std::string(file);
}

}  // namespace

LabelsFile::LabelsFile(const std::filesystem::path& path) {
    std::vector<char> scratch;
    read(read_text(path, scratch, largest_file), path.string());
}

LabelsFile::LabelsFile(std::string_view text, const std::string& where) {
    read(text, where);
}

void LabelsFile::read(std::string_view text, const std::string& where) {
    CsvReader csv(text, where);
    std::vector<std::string> record;
    if (!csv.next(record))
        throw Error("{}: empty; its first line names the columns, as in file,action", where);
    const Columns columns(record, csv.place());
    fields_ = {"action"};
    for (const auto c : columns.others) {
        check_field_name(csv.place(), record[c]);
        fields_.push_back(record[c]);
    }
    const auto width = record.size();
    while (csv.next(record)) {
        if (record.size() != width)
            throw Error("{}: {} value{}, not {} as the first line names columns", csv.place(), record.size(),
                        record.size() == 1 ? "" : "s", width);
        LabelRow row{record[*columns.file], printable(record[*columns.action]), {}, {}, {}};
        if (row.file.empty() || row.action.empty())
            throw Error("{}: no {}; give every row both", csv.place(), row.file.empty() ? "file" : "action");
        if (columns.start) row.start = frame_in(record[*columns.start], csv.place());
        if (columns.end) row.end = frame_in(record[*columns.end], csv.place());
        if (row.end && row.start.value_or(0) >= *row.end)
            throw Error("{}: the end, frame {}, is not after the start, frame {}", csv.place(), *row.end,
                        row.start.value_or(0));
        row.fields.push_back(row.action);
        for (const auto c : columns.others) row.fields.push_back(printable(record[c]));
        auto own = own_path(row.file);
        longest_path_ = std::max(longest_path_, own.size());
        by_path_[std::move(own)].push_back(rows_.size());
        rows_.push_back(std::move(row));
    }
    if (rows_.empty()) throw Error("{}: no row below the one that names the columns", where);
}

std::vector<std::size_t> LabelsFile::find(std::string_view path) const {
    path = without_extension(path);
    for (;;) {
        const auto found = path.size() <= longest_path_ ? by_path_.find(std::string(path)) : by_path_.end();
        if (found != by_path_.end()) return found->second;
        const auto slash = path.find('/');
        if (slash == std::string_view::npos) return {};
        path.remove_prefix(slash + 1);
    }
}

}  // namespace actformer::ingest
