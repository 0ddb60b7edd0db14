#include "server/import/run_import.h"

#include "api/words/limit_words.h"
#include "server/import/allowance.h"
#include "server/import/child_process.h"
#include "server/import/file_desk.h"
#include "server/import/mapped_bytes.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <system_error>
#include <utility>
#include <vector>

namespace server {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostLogBytes = 4096;

FileDescriptor checked(int fd, const char* what)
{
    if (fd < 0) throw std::system_error(errno, std::generic_category(), what);
    return FileDescriptor(fd);
}

std::vector<std::string> arguments_of(const ImportRun& run, const renderer::Limits& limits)
{
    return {std::string(run.is_picture ? kPictureWord : "mesh") + run.extension,
            std::to_string(limits.triangles),
            std::to_string(limits.texture_pixels),
            std::to_string(limits.import_memory_bytes),
            std::to_string(limits.import_output_bytes),
            std::to_string(limits.import_s)}; // of processor time: one thread cannot spend more
}

// The finished output, which nobody can change any more: a grandchild that still could makes sealing fail.
MappedBytes sealed(int output)
{
    if (::fcntl(output, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0) return {};
    return map_file(output);
}

class Run {
public:
    Run(const ImportRun& run, std::stop_token stop)
        : run_(run), allowed_(allowance(run.limits, run.bytes)), stop_(std::move(stop)),
          stop_event_(checked(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), "eventfd")),
          output_(
              checked(::memfd_create("heliograph-import", MFD_CLOEXEC | MFD_ALLOW_SEALING), "memfd_create")),
          desk_(make_desk())
    {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0)
            throw std::system_error(errno, std::generic_category(), "pipe2");
        log_read_ = FileDescriptor(ends[0]);
        log_write_ = FileDescriptor(ends[1]);
    }

    ImportRunEnd go()
    {
        ChildProcess child(run_.program,
                           arguments_of(run_, allowed_),
                           std::array{log_write_.get(), run_.file, output_.get(), desk_.second.get()});
        log_write_.reset();
        desk_.second.reset();
        const std::stop_callback wake(stop_, [this] { ::eventfd_write(stop_event_.get(), 1); });
        const Reason reason = watch(child);
        if (reason != Reason::ended) child.kill();
        const ChildProcess::End end = child.wait();
        read_log();
        result_.peak_bytes = end.peak_bytes;
        result_.cpu_s = end.cpu_s;
        if (reason == Reason::stopped) return std::move(result_);
        result_.outcome = reason == Reason::late ? late() : outcome_of(end);
        return std::move(result_);
    }

private:
    enum class Reason { ended, late, stopped };

    Reason watch(const ChildProcess& child)
    {
        const std::uint64_t allowed_s = std::min<std::uint64_t>(run_.limits.import_s, 365ull * 24 * 3600);
        const auto deadline = Clock::now() + std::chrono::seconds(allowed_s);
        std::array polled{pollfd{child.pidfd(), POLLIN, 0},
                          pollfd{stop_event_.get(), POLLIN, 0},
                          pollfd{desk_.first.get(), POLLIN, 0},
                          pollfd{log_read_.get(), POLLIN, 0}};
        int questions = 0;
        while (true) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
            if (left.count() <= 0) return Reason::late;
            const int timeout_ms = static_cast<int>(std::min<std::int64_t>(left.count(), 3'600'000));
            if (::poll(polled.data(), polled.size(), timeout_ms) < 0 && errno != EINTR)
                throw std::system_error(errno, std::generic_category(), "poll");
            if (polled[0].revents) return Reason::ended;
            if (polled[1].revents) return Reason::stopped;
            if (polled[2].revents &&
                (++questions > kMostQuestions || !answer_question(desk_.first.get(), run_.open))) {
                polled[2].fd = -1; // poll leaves it alone from now on
                desk_.first.reset();
            }
            if (polled[3].revents && !read_log()) polled[3].fd = -1;
        }
    }

    // False once the other end is closed.
    bool read_log()
    {
        std::array<char, 1024> piece{};
        const ssize_t got = ::read(log_read_.get(), piece.data(), piece.size());
        if (got < 0) return errno == EAGAIN || errno == EINTR;
        result_.log.append(piece.data(),
                           std::min(static_cast<std::size_t>(got), kMostLogBytes - result_.log.size()));
        return got > 0;
    }

    ImportFailure late()
    {
        result_.repeatable = false;
        return {"import_timeout",
                "the import took longer than " + std::to_string(run_.limits.import_s) + " s (" +
                    api::flag_of("import_s") + "); simplify or split the file"};
    }

    ImportFailure out_of_time()
    {
        if (allowed_.import_s == run_.limits.import_s) return late();
        result_.repeatable = false;
        return {"import_timeout",
                "the import took " + std::to_string(allowed_.import_s) +
                    " s of processor time, more than a file of this size should (10 s + 1 s a MiB); "
                    "simplify or split the file"};
    }

    ImportFailure out_of_memory()
    {
        result_.repeatable = false;
        return {"import_out_of_memory",
                "the import needs more than " + std::to_string(allowed_.import_memory_bytes) +
                    " bytes of memory (" + allowance_words("import_memory_bytes") +
                    "); simplify or split the file"};
    }

    ImportOutcome outcome_of(const ChildProcess::End& end)
    {
        if (end.signal == SIGXCPU) return out_of_time();
        if (end.signal == SIGKILL)
            return out_of_memory(); // not by us: the kernel's choice when memory is short
        if (end.signal == SIGXFSZ)
            return ImportFailure{"over_limit",
                                 "the imported form takes more than " +
                                     std::to_string(allowed_.import_output_bytes) + " bytes (" +
                                     allowance_words("import_output_bytes") + ")"};
        if (end.signal)
            return ImportFailure{"import_crashed",
                                 "the importer crashed on this file (signal " + std::to_string(end.signal) +
                                     "), so the file is likely broken: export it again, or as PLY or OBJ"};
        // 127: it could not be executed; 2 and 3: as it says itself. None of that is the file's doing.
        if (end.exit_code == 2 || end.exit_code == 3 || end.exit_code == 127)
            throw std::system_error(std::make_error_code(std::errc::operation_not_permitted),
                                    run_.program.string() + " does not run: " + result_.log);
        if (end.exit_code == 4) return out_of_memory(); // the output lives in memory
        if (end.exit_code != 0)
            return ImportFailure{"import_crashed",
                                 "the importer gave up with exit code " + std::to_string(end.exit_code)};
        ImportOutcome outcome = read_flat(sealed(output_.get()), run_.limits);
        const auto* failure = std::get_if<ImportFailure>(&outcome);
        if (failure && failure->code == "import_out_of_memory") return out_of_memory();
        return outcome;
    }

    const ImportRun& run_;
    const renderer::Limits allowed_;
    std::stop_token stop_;
    FileDescriptor stop_event_, output_;
    std::pair<FileDescriptor, FileDescriptor> desk_;
    FileDescriptor log_read_, log_write_;
    ImportRunEnd result_;
};

} // namespace

ImportRunEnd run_import(const ImportRun& run, std::stop_token stop)
{
    return Run(run, std::move(stop)).go();
}

} // namespace server
