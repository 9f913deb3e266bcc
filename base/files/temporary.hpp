// What must not outlive the process: signals remove it too.
#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <system_error>

namespace actformer {

/// A file or folder that is removed when a signal ends the process while this lives. Otherwise nothing is done to it.
class Temporary {
  public:
    enum class Removes { everything, empty_folder, nothing };

    /// `make` makes it and tells where; what it throws is thrown on. Nothing more is made once a signal has begun to remove.
    explicit Temporary(const std::function<std::filesystem::path()>& make,
                       Removes removes = Removes::everything);
    ~Temporary();
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    const std::filesystem::path& path() const { return here_->path; }

    /// Gives it the name `to`; it is not removed any more where that succeeds.
    void keep_as(const std::filesystem::path& to, std::error_code& error);

    struct Entry {
        std::filesystem::path path;
        Removes removes;
    };

  private:
    std::list<Entry>::iterator here_;
};

/// Removes what every Temporary names. From here on whoever makes or forgets one waits for the end of the process, which must follow.
void remove_temporaries();

}  // namespace actformer
