#include "base/numpy/npz.hpp"

#include "base/error.hpp"
#include "base/numpy/zip.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

constexpr std::string_view extension = ".npy";
constexpr std::size_t head = std::size_t{1} << 16;  // more than any header takes
constexpr std::size_t largest_metadata = std::size_t{1}
                                         << 20;  // texts and the like are wanted with the heads

}  // namespace

void read_npz(std::string_view bytes, const NpzSelection& selection,
              const std::function<void(const std::string&, const NumpyArray&)>& use) {
    std::vector<char> memory;
    for (const auto& member : zip_members(bytes)) {
        if (!member.name.ends_with(extension)) continue;
        const auto name = member.name.substr(0, member.name.size() - extension.size());
        if (selection.wanted && !selection.wanted(name)) continue;
        try {
            if (selection.heads_only && member.size > largest_metadata) {
                use(name, read_npy_header(zip_text(member, memory, head)));
                continue;
            }
            const auto array = zip_text(member, memory, selection.largest);
            if (array.size() == selection.largest)
                throw Error("more than the {} MiB that this array may have in an archive",
                            selection.largest >> 20);
            use(name, read_npy(array));
        } catch (const Error& e) {
            throw Error("'{}': {}", printable(name), e.what());
        }
    }
}

}  // namespace actformer
