#include "ingest/pipeline/source.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/nearest_file.hpp"
#include "base/files/regular_file.hpp"
#include "base/text/extension.hpp"
#include "base/text/html.hpp"
#include "base/threads/parallel.hpp"
#include "ingest/pipeline/packed_names.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t least_mapped = std::uint64_t{32} << 20;

using Extensions = std::vector<std::string>;

/// The length of the one of `extensions` that `name` ends in; 0 where it ends in none.
std::size_t extension_of(const std::string& name, const Extensions& extensions) {
    for (const auto& extension : extensions)
        if (name.size() > extension.size() && ends_in_extension(name, extension)) return extension.size();
    return 0;
}

std::string file_name(const std::string& path) {
    return path.substr(path.find_last_of('/') + 1);
}

/// One of the files that some archivers add, a companion to each of the others.
bool is_companion(const std::string& name) {
    return name.starts_with("._");
}

/// A file of the format, and no companion.
bool is_wanted(const std::string& path, const Extensions& extensions) {
    const auto name = file_name(path);
    return !is_companion(name) && extension_of(name, extensions) > 0;
}

std::string stem_of(const std::string& path, const Extensions& extensions) {
    const auto name = file_name(path);
    return name.substr(0, name.size() - extension_of(name, extensions));
}

/// A page of the web under an archive's name is said to be one.
void check_no_html(const fs::path& path) {
    constexpr std::size_t enough = 512;
    std::string start(enough, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(start.data(), static_cast<std::streamsize>(enough));
    start.resize(static_cast<std::size_t>(file.gcount()));
    if (is_html(start)) throw Error("{}: {}", path.string(), html_in_place_of("an archive"));
}

/// A member of an archive on its way to a disk.
class Unpacked {
  public:
    /// What there is of it in memory goes first.
    explicit Unpacked(RawFile& file) {
        file.unpacked = std::make_shared<const Scratch>("unpacked");
        file.in_memory = false;
        to_ = file.on_disk();
        descriptor_ = ::open(to_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
        if (descriptor_ < 0) fail();
        write(file.bytes.data(), file.bytes.size(), 0);
        file.bytes = {};
    }
    ~Unpacked() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    Unpacked(const Unpacked&) = delete;
    Unpacked& operator=(const Unpacked&) = delete;

    void write(const void* block, std::size_t size, std::int64_t offset) {
        for (const char* from = static_cast<const char*>(block); size > 0;) {
            const auto written = ::pwrite(descriptor_, from, size, offset);
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) fail();
            from += written;
            offset += written;
            size -= static_cast<std::size_t>(written);
        }
    }

    /// Some file systems tell only now that there was no room.
    void finish() {
        if (::close(std::exchange(descriptor_, -1)) != 0) fail();
    }

  private:
    [[noreturn]] void fail() const {
        throw Error(
            "{}: cannot be written: {}; large files of an archive are unpacked there: name a folder with "
            "room in TMPDIR",
            to_.parent_path().parent_path().string(), std::strerror(errno));
    }

    fs::path to_;
    int descriptor_ = -1;
};

/// What libarchive unpacks itself, of the archive alone: for other compressions, as lrzip's and grzip's, it starts a program that it finds in
/// PATH, and of an mtree it reads any file that its text names.
void support_what_is_wanted(archive* reader) {
    for (const auto support :
         {archive_read_support_format_tar, archive_read_support_format_zip, archive_read_support_format_7zip,
          archive_read_support_format_rar, archive_read_support_format_rar5, archive_read_support_format_cpio,
          archive_read_support_filter_gzip, archive_read_support_filter_bzip2, archive_read_support_filter_xz,
          archive_read_support_filter_lzma, archive_read_support_filter_lzip,
          archive_read_support_filter_zstd, archive_read_support_filter_lz4,
          archive_read_support_filter_compress})
        support(reader);
}

/// One archive, read front to back.
class Archive {
  public:
    Archive(fs::path path, std::uint64_t largest_file)
        : path_(std::move(path)), largest_(largest_file), reader_(archive_read_new(), &archive_read_free) {
        check_no_html(path_);
        support_what_is_wanted(reader_.get());
        if (archive_read_open_filename(reader_.get(), path_.c_str(), std::size_t{1} << 17) != ARCHIVE_OK)
            throw Error("{}: neither a folder nor an archive that can be read: {}", path_.string(),
                        message());
    }

    /// Moves to the next wanted member; false at the end.
    bool next(const Extensions& extensions, RawFile& file) {
        for (;;) {
            archive_entry* entry = nullptr;
            const int result = archive_read_next_header(reader_.get(), &entry);
            if (result == ARCHIVE_EOF) return false;
            if (result < ARCHIVE_WARN) broken();
            const char* name = archive_entry_pathname(entry);
            if (!name) name = archive_entry_pathname_utf8(entry);
            member_ = name ? name : "(a name that cannot be read)";
            if (archive_entry_filetype(entry) != AE_IFREG || !is_wanted(member_, extensions)) continue;
            file.path = path_.string() + ":" + member_;
            file.stem = stem_of(member_, extensions);
            file.inside = member_;
            file.in_memory = true;
            file.unreadable.clear();
            file.bytes.clear();
            file.unpacked.reset();
            file.size = static_cast<std::uint64_t>(std::max<la_int64_t>(archive_entry_size(entry), 0));
            return true;
        }
    }

    /// Reads the member that next() stopped at: into memory, or where it is large onto a disk. One beyond the size limit is marked
    /// unreadable and skipped.
    void read(RawFile& file) {
        std::optional<Unpacked> on_disk;
        file.bytes.reserve(std::min(file.size, least_mapped) + text_padding);
        for (;;) {
            const void* block = nullptr;
            std::size_t size = 0;
            la_int64_t offset = 0;
            const int result = archive_read_data_block(reader_.get(), &block, &size, &offset);
            if (result == ARCHIVE_EOF) break;
            if (result < ARCHIVE_WARN) broken();
            file.size = static_cast<std::uint64_t>(offset) + size;
            if (file.size > largest_) {
                file.unreadable = fmt::format("more than the {} MiB that a file may have", largest_ >> 20);
                file.bytes.clear();
                file.unpacked.reset();
                return;
            }
            if (!on_disk && file.size >= least_mapped) on_disk.emplace(file);
            if (on_disk) {
                on_disk->write(block, size, offset);
            } else {
                file.bytes.resize(file.size);
                if (size > 0) std::memcpy(file.bytes.data() + offset, block, size);
            }
        }
        if (on_disk)
            on_disk->finish();
        else
            file.bytes.resize(file.size + text_padding);
    }

    /// Compressed bytes read so far.
    std::uint64_t position() const {
        return static_cast<std::uint64_t>(archive_filter_bytes(reader_.get(), -1));
    }

  private:
    std::string message() const {
        const char* text = archive_error_string(reader_.get());
        return text ? text : "no reason given";
    }
    [[noreturn]] void broken() const {
        throw Error("{}: broken archive {}: {}; download it again", path_.string(),
                    member_.empty() ? "at its start" : "near member " + member_, message());
    }

    fs::path path_;
    std::uint64_t largest_;  ///< keeps a hostile member from eating the memory
    std::unique_ptr<archive, decltype(&archive_read_free)> reader_;
    std::string member_;
};

struct Found {
    std::string path;
    std::size_t given = 0;  ///< which of the RAW paths it lies below, or is
    bool archive = false;
    std::uint64_t bytes = 0;
    std::int64_t changed = 0;  ///< nanoseconds
    std::string unreadable{};  ///< why; empty where nothing speaks against it
};

/// Which file or folder it is, whatever path leads there; nothing where none does.
std::optional<std::pair<dev_t, ino_t>> identity_of(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return {};
    return std::pair(status.st_dev, status.st_ino);
}

/// The files below a folder. Links to folders are followed, each folder once: circles end, and where a folder is there both itself and
/// by a link, its files have their own paths. Links to a folder that the given one lies in are not followed: what is beside it was not given.
class FolderWalk {
  public:
    FolderWalk(std::size_t given, const Extensions& extensions, const std::vector<fs::path>& left_out,
               std::vector<Found>& items)
        : given_(given), extensions_(extensions), items_(items) {
        for (const auto& folder : left_out) is_new(folder);
    }

    void walk(const fs::path& folder) {
        const auto before = static_cast<std::ptrdiff_t>(items_.size());
        std::error_code ignored;  // a folder that is not there is refused when it is walked
        for (auto above = fs::canonical(folder, ignored); above.has_relative_path();) {
            above = above.parent_path();
            is_new(above);
        }
        for (links_.insert(folder); !links_.empty();) {
            const auto next = links_.extract(links_.begin()).value();
            if (is_new(next)) walk_unlinked(next);
        }
        std::sort(items_.begin() + before, items_.end(),
                  [](const Found& a, const Found& b) { return a.path < b.path; });
    }

    /// Paths of archives and compressed files, which are none of the items.
    const std::vector<std::string>& packed() const { return packed_; }

  private:
    bool is_new(const fs::path& folder) {
        const auto identity = identity_of(folder);
        return identity && walked_.insert(*identity).second;
    }

    void walk_unlinked(const fs::path& folder) {
        std::error_code error;
        for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
             it.increment(error)) {
            std::error_code ignored;  // a file that cannot be looked at is rejected when it is read
            if (!it->is_directory(ignored)) {
                const auto& path = it->path().native();
                if (is_wanted(path, extensions_))
                    items_.push_back({path, given_});
                else if (is_packed(path) && !is_companion(file_name(path)) && it->is_regular_file(ignored))
                    packed_.push_back(path);
            } else if (it->is_symlink(ignored)) {
                links_.insert(it->path());
            } else if (!is_new(it->path())) {
                it.disable_recursion_pending();
            }
        }
        if (error) throw Error("{}: the folder cannot be read: {}", folder.string(), error.message());
    }

    std::size_t given_;
    const Extensions& extensions_;
    std::vector<Found>& items_;
    std::vector<std::string> packed_;
    std::set<fs::path> links_;                  ///< to folders, still to be walked
    std::set<std::pair<dev_t, ino_t>> walked_;  ///< folders, or left out
};

/// Sizes and times of change; 0 for a file that vanished, which is rejected when it is read.
void look_at(std::vector<Found>& items, unsigned threads) {
    parallel_for(items.size(), threads, [&](std::size_t i, unsigned) {
        struct stat status {};
        if (::stat(items[i].path.c_str(), &status) != 0) return;
        if (S_ISREG(status.st_mode))
            items[i].bytes = static_cast<std::uint64_t>(status.st_size);
        else
            items[i].unreadable = fmt::format("{}, and no regular file", irregular_kind(items[i].path));
        items[i].changed = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
    });
}

}  // namespace

fs::path RawFile::on_disk() const {
    return unpacked ? unpacked->path() / "member" : fs::path(path);
}

std::string_view RawFile::text(std::vector<char>& scratch, std::uint64_t largest) const {
    if (!unreadable.empty()) throw Error("{}: {}", path, unreadable);
    if (in_memory) return {bytes.data(), bytes.size() - text_padding};
    return read_text(on_disk(), scratch, largest);
}

RawText TextMemory::read(const RawFile& file) {
    mapped_.reset();
    if (file.in_memory || file.size < least_mapped || file.size > largest_)
        return file.raw(file.text(scratch_, largest_));
    mapped_.emplace(file.on_disk());
    return file.raw(mapped_->text(), &*mapped_);
}

struct Source::State {
    Extensions extensions;
    std::uint64_t largest = usual_largest_file;
    std::vector<fs::path> given;
    std::vector<Found> items;
    std::vector<std::string> not_read;  ///< remarks
    std::size_t at = 0;
    std::uint64_t files = 0, passed = 0;
    std::unique_ptr<Archive> archive;
    std::function<bool(const RawFile&)> unpacks;  ///< empty: all

    /// The path of a file below the folder it was found in; of a file given by itself, as it was given.
    std::string inside(const Found& item) const {
        const auto& folder = given[item.given].native();
        if (folder.size() >= item.path.size()) return item.path;
        return item.path.substr(item.path.find_first_not_of('/', folder.size()));
    }

    /// Of `packed` files in a folder that was given, those that were not given themselves.
    void remark_on(std::size_t folder, const std::vector<std::string>& packed) {
        if (packed.empty()) return;
        std::set<std::optional<std::pair<dev_t, ino_t>>> themselves;
        for (const auto& path : given) themselves.insert(identity_of(path));
        std::vector<std::string> others;
        for (const auto& path : packed)
            if (!themselves.contains(identity_of(path))) others.push_back(inside({path, folder}));
        for (auto& line : remarks_on_packed(given[folder], std::move(others)))
            not_read.push_back(std::move(line));
    }

    bool step(RawFile& file, bool with_bytes) {
        for (; at < items.size(); ++at) {
            const auto& item = items[at];
            if (!item.archive) {
                file = RawFile{item.path,    stem_of(item.path, extensions),
                               inside(item), files++,
                               item.bytes,   false,
                               {},           item.unreadable};
                passed += item.bytes;
                ++at;
                return true;
            }
            if (!archive) archive = std::make_unique<Archive>(item.path, largest);
            if (archive->next(extensions, file)) {
                file.index = files++;
                if (with_bytes && (!unpacks || unpacks(file))) archive->read(file);
                return true;
            }
            archive.reset();
            passed += item.bytes;
        }
        return false;
    }
};

Source::Source(const std::vector<fs::path>& raw, const std::vector<std::string_view>& extensions,
               std::uint64_t largest_file, unsigned threads, const std::vector<fs::path>& left_out)
    : state_(new State) {
    state_->largest = largest_file;
    state_->extensions.assign(extensions.begin(), extensions.end());
    state_->given = raw;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        std::error_code error;
        const auto status = fs::status(raw[i], error);
        if (!fs::exists(status))
            throw Error("{}: no such file or folder{}", raw[i].string(), did_you_mean(raw[i]));
        if (fs::is_directory(status)) {
            FolderWalk folder(i, state_->extensions, left_out, state_->items);
            folder.walk(raw[i]);
            state_->remark_on(i, folder.packed());
        } else {
            refuse_irregular(raw[i]);
            const bool archive = extension_of(raw[i].string(), state_->extensions) == 0;
            if (archive)
                const Archive opens(
                    raw[i], largest_file);  // so that a wrong argument is said before any work is done
            state_->items.push_back({raw[i].string(), i, archive});
        }
    }
    look_at(state_->items, thread_count(threads));
    if (state_->items.empty()) {
        std::string where;
        for (const auto& path : raw) where += (where.empty() ? "" : ", ") + path.string();
        throw Error("{}: no {} file there{}{}", where, fmt::join(extensions, ", "),
                    state_->not_read.empty() ? "" : "; ", fmt::join(state_->not_read, "; "));
    }
}

Source::~Source() = default;

void Source::unpack_only(std::function<bool(const RawFile&)> wanted) {
    state_->unpacks = std::move(wanted);
}

bool Source::next(RawFile& file) {
    return state_->step(file, true);
}
bool Source::next_name(RawFile& file) {
    return state_->step(file, false);
}

std::uint64_t Source::bytes_total() const {
    std::uint64_t total = 0;
    for (const auto& item : state_->items) total += item.bytes;
    return total;
}

std::uint64_t Source::bytes_read() const {
    return state_->passed + (state_->archive ? state_->archive->position() : 0);
}

const std::vector<std::string>& Source::not_read() const {
    return state_->not_read;
}

std::string Source::listing() const {
    std::vector<std::string> from_root;
    for (const auto& path : state_->given) from_root.push_back(fs::absolute(path).string());
    std::string lines;
    for (const auto& item : state_->items)
        fmt::format_to(std::back_inserter(lines), "{}{}\n{} {}\n", from_root[item.given],
                       std::string_view(item.path).substr(state_->given[item.given].native().size()),
                       item.bytes, item.changed);
    return checksum(lines);
}

}  // namespace actformer::ingest
