#include "base/numpy/npz.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <cstring>
#include <limits>
#include <memory>

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

constexpr std::string_view extension = ".npy";
constexpr std::size_t head = std::size_t{1} << 16;  // more than any header takes
constexpr std::size_t largest_metadata = std::size_t{1}
                                         << 20;  // texts and the like are wanted with the heads

class Zip {
  public:
    explicit Zip(std::string_view bytes) : reader_(archive_read_new(), &archive_read_free) {
        // By the list at its end: an archive that was cut short has none.
        archive_read_support_format_zip_seekable(reader_.get());
        if (archive_read_open_memory(reader_.get(), bytes.data(), bytes.size()) != ARCHIVE_OK) broken();
    }

    /// Moves to the next array; false at the end.
    bool next(std::string& name) {
        for (;;) {
            archive_entry* entry = nullptr;
            const int result = archive_read_next_header(reader_.get(), &entry);
            if (result == ARCHIVE_EOF) return false;
            if (result < ARCHIVE_WARN) broken();
            const char* path = archive_entry_pathname(entry);
            member_ = path ? path : "(a name that cannot be read)";
            if (!member_.ends_with(extension)) continue;
            name = member_.substr(0, member_.size() - extension.size());
            size_ = archive_entry_size_is_set(entry) ? static_cast<std::uint64_t>(archive_entry_size(entry))
                                                     : std::numeric_limits<std::uint64_t>::max();
            return true;
        }
    }

    /// Unpacks the array up to `most` bytes.
    std::string_view read(std::vector<char>& memory, std::uint64_t most) {
        std::size_t filled = 0;
        while (filled < most) {
            // As much as has come so far once more: a size that the archive invents costs no memory.
            const auto room = std::min<std::uint64_t>(most, std::max<std::uint64_t>(2 * filled, head));
            if (memory.size() < room) memory.resize(room);
            const auto got = archive_read_data(reader_.get(), memory.data() + filled, room - filled);
            if (got < 0) broken();
            if (got == 0) break;
            filled += static_cast<std::size_t>(got);
        }
        return {memory.data(), filled};
    }

    std::uint64_t size() const { return size_; }  ///< of the array at hand, as the archive says

  private:
    [[noreturn]] void broken() const {
        const char* why = archive_error_string(reader_.get());
        throw Error("{}: {}",
                    member_.empty() ? "no zip archive as numpy.savez writes it" : in_quotes(member_),
                    why ? printable(why) : "damaged");
    }

    std::unique_ptr<archive, decltype(&archive_read_free)> reader_;
    std::string member_;
    std::uint64_t size_ = 0;
};

}  // namespace

void read_npz(std::string_view bytes, const NpzSelection& selection,
              const std::function<void(const std::string&, const NumpyArray&)>& use) {
    Zip zip(bytes);
    std::vector<char> memory;
    for (std::string name; zip.next(name);) {
        if (selection.wanted && !selection.wanted(name)) continue;
        const auto where = printable(name);
        try {
            if (selection.heads_only && zip.size() > largest_metadata) {
                use(name, read_npy_header(zip.read(memory, head)));
                continue;
            }
            const auto array = zip.read(memory, selection.largest);
            if (array.size() == selection.largest)
                throw Error("more than the {} MiB that this array may have in an archive",
                            selection.largest >> 20);
            use(name, read_npy(array));
        } catch (const Error& e) {
            throw Error("'{}': {}", where, e.what());
        }
    }
}

}  // namespace actformer
