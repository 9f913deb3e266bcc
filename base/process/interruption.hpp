// SIGINT, SIGTERM and SIGHUP: the program ends in order, and says how to go on.
#pragma once

#include <sys/types.h>

#include <list>
#include <stdexcept>
#include <string>

namespace actformer {

/// From here on those signals remove what is temporary (see Temporary), say so in a line on standard error and end the program with
/// exit code 128 + the signal; what the caller ignores (nohup) stays ignored. Writing beyond a limit on files' sizes, or to a pipe
/// that nobody reads, fails with an error and ends nothing. Standard streams that are closed stay so, and no file is opened in their place. To be called
/// first of all, while there is one thread.
void end_in_order();

/// In a new process before it becomes another program: signals are as this program found them. Safe between fork and exec.
void restore_signals();

/// Thrown at a safe point: a signal has asked the work to stop.
class Interrupted : public std::exception {
  public:
    /// `how_to_go_on` follows "stopped by SIGTERM; ".
    Interrupted(int signal, const std::string& how_to_go_on);
    const char* what() const noexcept override { return text_.c_str(); }
    int exit_code() const { return 128 + signal_; }

  private:
    int signal_;
    std::string text_;
};

/// While one lives a signal ends nothing by itself: the work looks for it where it can stop without loss. A second SIGINT ends the
/// program as ever.
class SafePoints {
  public:
    SafePoints();
    /// Ends the program where a signal came after the last safe point.
    ~SafePoints();
    SafePoints(const SafePoints&) = delete;
    SafePoints& operator=(const SafePoints&) = delete;

    /// Whether a signal has come.
    bool asked() const;

    /// Stops here: throws Interrupted.
    [[noreturn]] void stop(const std::string& how_to_go_on) const;

  private:
    int exceptions_;  ///< in flight when it began
};

/// While it lives, the first signal is passed on to a child of this process, as SIGTERM.
class PassedOn {
  public:
    explicit PassedOn(pid_t child);
    ~PassedOn();
    PassedOn(const PassedOn&) = delete;
    PassedOn& operator=(const PassedOn&) = delete;

  private:
    std::list<pid_t>::iterator here_;
};

/// While it lives, the line that a signal ends the program with says how to go on.
class GoesOn {
  public:
    explicit GoesOn(const std::string& how);
    ~GoesOn();
    GoesOn(const GoesOn&) = delete;
    GoesOn& operator=(const GoesOn&) = delete;

  private:
    std::list<std::string>::iterator here_;
};

}  // namespace actformer
