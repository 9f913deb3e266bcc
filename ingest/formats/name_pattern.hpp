// What a file's name and folders say of its clip: "dataset-2_{action}_{style}_{index}", "{action}/{index}".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

/// Literal text and fields in braces. A field takes the shortest run of one character or more that lets the
/// rest match, the last one all that is left; {*} takes a run and forgets it. A / stands between a folder and what is in it: a
/// pattern with n of them speaks of the last n folders. No field reaches across a /.
class NamePattern {
  public:
    /// Throws Error showing the right form. {action} must be among the fields where `needs_action`; an extension of a known format
    /// is ignored.
    explicit NamePattern(std::string_view text, bool needs_action = true);

    const std::string& text() const { return text_; }
    const std::vector<std::string>& fields() const { return fields_; }  ///< in order, {*} apart
    std::size_t action() const {
        return action_;
    }  ///< index into fields(); their number where it is not among them

    /// The fields' values in `path`, a file's path without its extension; nothing where it does not fit. The file's name alone does
    /// for a pattern without a /.
    std::optional<std::vector<std::string>> match(std::string_view path) const;

  private:
    /// A field and the literal text before it.
    struct Part {
        std::string before;
        bool forgotten = false;
    };

    /// What lies between two /.
    struct Component {
        std::vector<Part> parts;
        std::string tail;  ///< literal text after the last field
    };

    static bool match(const Component& component, std::string_view name, std::vector<std::string>& values);
    Component read_component(std::string_view text);
    void add_field(std::string_view name);

    std::string text_;
    std::vector<Component> components_;
    std::vector<std::string> fields_;
    std::size_t action_ = 0;
};

/// Throws Error, beginning with `where`, unless `name` may be that of a field: letters, digits, - and _, and nothing that a dataset
/// stores of every clip.
void check_field_name(const std::string& where, std::string_view name);

/// `path` without the extension of a known format, in any case.
std::string_view without_extension(std::string_view path);

}  // namespace actformer::ingest
