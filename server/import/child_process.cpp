#include "server/import/child_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <system_error>

namespace server {

namespace {

void check(int error, const char* what)
{
    if (error) throw std::system_error(error, std::generic_category(), what);
}

class FileActions {
public:
    explicit FileActions(std::span<const int> descriptors)
    {
        constexpr int kAboveTargets = 64;
        check(::posix_spawn_file_actions_init(&actions_), "posix_spawn_file_actions_init");
        // Copies far above the targets first: a target may be another's source.
        for (const int fd : descriptors) {
            copies_.emplace_back(::fcntl(fd, F_DUPFD_CLOEXEC, kAboveTargets));
            if (!copies_.back()) throw std::system_error(errno, std::generic_category(), "fcntl");
        }
        check(::posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0), "addopen");
        check(::posix_spawn_file_actions_addopen(&actions_, 1, "/dev/null", O_WRONLY, 0), "addopen");
        int target = 2;
        for (const FileDescriptor& copy : copies_)
            check(::posix_spawn_file_actions_adddup2(&actions_, copy.get(), target++), "adddup2");
        // Whatever else is open here without O_CLOEXEC, sockets of clients among it, stays here.
        check(::posix_spawn_file_actions_addclosefrom_np(&actions_, target), "addclosefrom");
    }
    ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_{};
    std::vector<FileDescriptor> copies_;
};

// No signal blocked or ignored, and a group of its own: a terminal's Ctrl-C is for the service, which
// decides.
class Attributes {
public:
    Attributes()
    {
        check(::posix_spawnattr_init(&attributes_), "posix_spawnattr_init");
        sigset_t none, all;
        ::sigemptyset(&none);
        ::sigfillset(&all);
        ::posix_spawnattr_setsigmask(&attributes_, &none);
        ::posix_spawnattr_setsigdefault(&attributes_, &all);
        ::posix_spawnattr_setpgroup(&attributes_, 0);
        ::posix_spawnattr_setflags(&attributes_,
                                   POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    ~Attributes() { ::posix_spawnattr_destroy(&attributes_); }
    Attributes(const Attributes&) = delete;
    Attributes& operator=(const Attributes&) = delete;
    const posix_spawnattr_t* get() const { return &attributes_; }

private:
    posix_spawnattr_t attributes_{};
};

double seconds(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

} // namespace

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments,
                           std::span<const int> descriptors)
{
    std::string name = program.filename().string();
    std::vector<std::string> words = arguments;
    std::vector<char*> argv{name.data()};
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    std::array<char*, 1> environment{nullptr};
    const FileActions actions(descriptors);
    const Attributes attributes;
    check(::posix_spawn(
              &pid_, program.c_str(), actions.get(), attributes.get(), argv.data(), environment.data()),
          program.c_str());
    pidfd_ = FileDescriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
    if (pidfd_) return;
    const int error = errno;
    kill();
    wait();
    check(error, "pidfd_open");
}

ChildProcess::~ChildProcess()
{
    if (pid_ < 0) return;
    kill();
    wait();
}

// The child is not reaped before wait(), so its number cannot be another's.
void ChildProcess::kill()
{
    if (pid_ > 0) ::kill(pid_, SIGKILL);
}

ChildProcess::End ChildProcess::wait()
{
    End end;
    int status = 0;
    rusage usage{};
    pid_t got = 0;
    do {
        got = ::wait4(pid_, &status, 0, &usage);
    } while (got < 0 && errno == EINTR);
    pid_ = -1;
    if (got < 0) return end;
    if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    end.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    end.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    return end;
}

} // namespace server
