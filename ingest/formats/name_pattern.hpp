// What a file's name says of its clip: "dataset-2_{action}_{style}_{index}".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

/// Literal text and fields in braces. A field takes the shortest run of one character or more that lets the
/// rest match, the last one all that is left; {*} takes a run and forgets it.
class NamePattern {
  public:
    /// Throws Error showing the right form. {action} must be among the fields; an extension .bvh is ignored.
    explicit NamePattern(std::string_view text);

    const std::string& text() const { return text_; }
    const std::vector<std::string>& fields() const { return fields_; }  ///< in order, {*} apart
    std::size_t action() const { return action_; }                      ///< index into fields()

    /// The fields' values in `stem`, a file name without its extension; nothing where it does not fit.
    std::optional<std::vector<std::string>> match(std::string_view stem) const;

  private:
    /// A field and the literal text before it.
    struct Part {
        std::string before;
        bool forgotten = false;
    };

    void add_field(std::string_view name);

    std::string text_;
    std::vector<Part> parts_;
    std::string tail_;  ///< literal text after the last field
    std::vector<std::string> fields_;
    std::size_t action_ = 0;
};

}  // namespace actformer::ingest
