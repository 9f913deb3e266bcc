#include "base/files/scratch.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/error.hpp"

namespace actformer {

namespace fs = std::filesystem;

namespace {

constexpr const char* scratch_prefix = "actformer-scratch-";

/// A lock on the folder; closed where another process holds it, or where it is no folder of this user's.
Descriptor lock_on(const fs::path& folder) {
    Descriptor file(folder, O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
    struct stat status {};
    if (file.get() >= 0 && ::fstat(file.get(), &status) == 0 && status.st_uid == ::geteuid() &&
        ::flock(file.get(), LOCK_EX | LOCK_NB) == 0)
        return file;
    return {};
}

fs::path system_place() {
    std::error_code error;
    auto place = fs::temp_directory_path(error);
    if (!error) return place;
    const char* set = nullptr;
    for (const auto* name : {"TMPDIR", "TMP", "TEMP", "TEMPDIR"})
        if (!set) set = std::getenv(name);
    throw Error("{}: no folder for temporary files ({}); let TMPDIR name one", set ? set : "/tmp",
                error.message());
}

/// Removes what processes left that are no more: nobody holds it.
void remove_stale(const fs::path& below) {
    std::error_code error;
    for (fs::directory_iterator entry(below, error), end; !error && entry != end; entry.increment(error)) {
        if (!entry->path().filename().string().starts_with(scratch_prefix)) continue;
        const auto lock = lock_on(entry->path());
        if (lock.get() < 0) continue;
        std::error_code ignored;
        fs::remove_all(entry->path(), ignored);
    }
}

}  // namespace

Scratch::Scratch(const std::string& purpose, const fs::path& where) {
    const auto below = where.empty() ? system_place() : where;
    remove_stale(below);
    const auto make = [&]() -> fs::path {
        auto name = (below / (scratch_prefix + purpose + "-XXXXXX")).string();
        if (!::mkdtemp(name.data()))
            throw Error("{}: no folder can be made in it ({}); choose another place", below.string(),
                        std::strerror(errno));
        return name;
    };
    // Another process that removes stale folders may take this one for stale before it is locked: then another is made. Where the file
    // system knows no locks, nobody removes anything.
    for (int attempt = 0; attempt < 5; ++attempt) {
        folder_ = std::make_unique<Temporary>(make);
        lock_ = lock_on(path());
        if (lock_.get() >= 0 && fs::exists(path())) return;
        lock_.close();
        fs::remove(path());
    }
    folder_ = std::make_unique<Temporary>(make);
}

Scratch::~Scratch() {
    std::error_code ignored;
    fs::remove_all(path(), ignored);
}

}  // namespace actformer
