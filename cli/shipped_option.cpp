#include "cli/shipped_option.hpp"

#include <fstream>

namespace actformer::cli {
namespace {

/// The first sentence of the comment that a file begins with.
std::string first_sentence(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string text;
    for (std::string line; std::getline(file, line) && line.starts_with('#');)
        text += (text.empty() ? "" : " ") + line.substr(std::min<std::size_t>(2, line.size()));
    const auto end = text.find(". ");
    return end == std::string::npos ? text : text.substr(0, end + 1);
}

}  // namespace

void lists_shipped(CLI::App* command, const std::string& folder) {
    command->preparse_callback([folder](std::size_t words) {
        if (words > 0) return;
        for (const auto& name : shipped_names(folder))
            fmt::print("{:<20} {}\n", name, first_sentence(shipped_folder() / folder / (name + ".yaml")));
        throw CLI::Success();
    });
}

}  // namespace actformer::cli
