#include "cli/man_pages.hpp"

#include <fmt/format.h>

#include <sstream>

#include "base/files/file.hpp"

namespace actformer::cli {
namespace {

namespace fs = std::filesystem;

/// Text as roff takes it: no character of it is a command.
std::string plain_text(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '.' && (out.empty() || out.back() == '\n')) out += "\\&";
        switch (c) {  // what can be typed again stays so: roff has other quotes and dashes in mind
            case '\\':
                out += "\\e";
                break;
            case '-':
                out += "\\-";
                break;
            case '\'':
                out += "\\(aq";
                break;
            case '`':
                out += "\\(ga";
                break;
            case '^':
                out += "\\(ha";
                break;
            case '~':
                out += "\\(ti";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string bold(std::string_view text) {
    return fmt::format("\\fB{}\\fR", plain_text(text));
}

/// "-o,--out" and " DIR REQUIRED": bold words, and what follows them.
std::string tag(const OptionHelp& option) {
    std::string names;
    for (std::size_t at = 0; at <= option.name.size();) {
        const auto end = std::min(option.name.find(',', at), option.name.size());
        names += (names.empty() ? "" : ", ") + bold(option.name.substr(at, end - at));
        at = end + 1;
    }
    return names + plain_text(option.value);
}

std::string options_text(const char* heading, const std::vector<OptionHelp>& options) {
    if (options.empty()) return {};
    auto text = fmt::format(".SH {}\n", heading);
    for (const auto& option : options)
        text += fmt::format(".TP\n{}\n{}\n", tag(option), plain_text(option.text));
    return text;
}

/// Lines that begin with spaces stand as they are; others are filled.
std::string footer_text(const std::string& footer) {
    if (footer.empty()) return {};
    std::string text = ".SH NOTES\n";
    bool verbatim = false;
    std::istringstream lines(footer);
    for (std::string line; std::getline(lines, line);) {
        if (line == "Examples:") {
            text = ".SH EXAMPLES\n";
            continue;
        }
        if (const bool indented = line.starts_with("  "); indented != verbatim) {
            text += indented ? ".PP\n.nf\n" : ".fi\n.PP\n";
            verbatim = indented;
        }
        text += plain_text(line.substr(verbatim ? 2 : 0)) + "\n";
    }
    return text + (verbatim ? ".fi\n" : "");
}

std::string joined(const std::string& path, const std::string& name, char separator) {
    return path.empty() ? name : path + separator + name;
}

class Pages {
  public:
    explicit Pages(const fs::path& folder) : folder_(folder) {}

    void write(const CommandHelp& command, const std::string& before) {
        const auto page = joined(before, command.name, '-');
        write_whole(folder_ / (page + ".1"), text(command, before));
        ++count_;
        for (const auto& one : command.commands) write(one, page);
    }
    std::size_t count() const { return count_; }

  private:
    static std::string text(const CommandHelp& command, const std::string& before) {
        const auto page = joined(before, command.name, '-');
        auto typed = page;
        std::ranges::replace(typed, '-', ' ');
        auto out =
            fmt::format(".TH \"{}\" 1 \"\" \"actformer {}\" \"actformer\"\n.SH NAME\n{} \\- {}\n",
                        plain_text(page), ACTFORMER_VERSION, plain_text(page), plain_text(command.text));
        out += fmt::format(".SH SYNOPSIS\n{}{}{}", bold(typed), command.commands.empty() ? "" : " COMMAND",
                           command.options.empty() ? "" : " [OPTIONS]");
        for (const auto& one : command.positionals) out += " " + plain_text(one.name + one.value);
        out += "\n";
        out += options_text("ARGUMENTS", command.positionals);
        out += options_text("OPTIONS", command.options);
        out += commands_text(command, page);
        out += footer_text(command.footer);
        if (!before.empty()) out += fmt::format(".SH SEE ALSO\n.BR {} (1)\n", plain_text(before));
        return out;
    }

    static std::string commands_text(const CommandHelp& command, const std::string& page) {
        if (command.commands.empty()) return {};
        std::string out = ".SH COMMANDS\n";
        for (const auto& one : command.commands)
            out += fmt::format(".TP\n.BR {} (1)\n{}\n", plain_text(joined(page, one.name, '-')),
                               plain_text(one.text));
        return out;
    }

    const fs::path& folder_;
    std::size_t count_ = 0;
};

}  // namespace

std::size_t write_man_pages(const CommandHelp& root, const fs::path& folder) {
    make_folders(folder);
    Pages pages(folder);
    pages.write(root, "");
    return pages.count();
}

}  // namespace actformer::cli
