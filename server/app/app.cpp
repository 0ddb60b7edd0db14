#include "server/app/app.h"

#include "api/build_info.h"
#include "server/http/http_server.h"
#include "server/import/import_service.h"
#include "server/jobs/job_service.h"
#include "server/store/blob_store.h"
#include "server/store/data_folder.h"
#include "server/store/sqlite_store.h"

#include <algorithm>
#include <malloc.h>
#include <ostream>
#include <sys/resource.h>
#include <system_error>
#include <unistd.h>

namespace server {

namespace {

std::filesystem::path import_program_of(const ServiceOptions& options)
{
    std::filesystem::path program =
        options.import_program.empty()
            ? std::filesystem::read_symlink("/proc/self/exe").parent_path() / "heliograph-import"
            : options.import_program;
    if (access(program.c_str(), X_OK) != 0)
        throw std::system_error(errno,
                                std::generic_category(),
                                "the import program " + program.string() +
                                    " cannot be run; --import-program tells where it is");
    return program;
}

// glibc gives threads arenas of their own, up to eight a core; most of ours only wait. And it learns to keep what is
// large and freed; ours is a piece of an asset or a body, and goes back at once.
void keep_memory_small()
{
    constexpr int kArenas = 2, kLarge = 128 << 10;
    mallopt(M_ARENA_MAX, kArenas);
    mallopt(M_MMAP_THRESHOLD, kLarge);
}

// Each connection is a descriptor; the default of 1024 is for programs that use select().
void allow_many_files()
{
    rlimit files{};
    if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
    constexpr rlim_t kEnough = 8192;
    files.rlim_cur = std::max(files.rlim_cur, std::min(files.rlim_max, kEnough));
    setrlimit(RLIMIT_NOFILE, &files); // refused: there are fewer connections
}

std::string url_of(const std::string& host, int port)
{
    const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
    return "http://" + name + ":" + std::to_string(port);
}

} // namespace

int run_service(const ServiceOptions& options, const StopSignals& signals, std::ostream& out)
{
    keep_memory_small();
    allow_many_files();
    const Log log(options.log_level);
    const std::filesystem::path import_program = import_program_of(options);
    const DataFolder folder(options.data);
    const std::unique_ptr<Store> store = open_sqlite_store(folder.path() / "jobs.sqlite");
    BlobStore blobs(folder.path() / "blobs");
    ImportService imports(import_program, blobs, options.limits, log, folder.path() / "meshes");
    JobService jobs(*store, blobs, imports, {options.limits, options.threads, log});
    HttpServer http(jobs,
                    *store,
                    blobs,
                    imports,
                    log,
                    {.host = options.host,
                     .port = options.port,
                     .health_port = options.health_port,
                     .limits = options.limits,
                     .on_deaf = [&signals] { signals.raise(); }});
    jobs.start();
    http.start();

    const std::string url = url_of(options.host, http.port());
    out << "heliographd ready on " << url << " (health " << url_of(options.host, http.health_port()) << ")"
        << std::endl;
    log.write(LogLevel::info,
              "ready",
              {{"url", url}, {"version", api::build_info().version}, {"commit", api::build_info().commit}});

    const int signal = signals.wait();
    signals.leave_on_next();
    // A service that nobody can reach is of use to none but a supervisor that starts it anew.
    const bool deaf = !http.listening();
    log.write(LogLevel::info, "stopping", {{"signal", std::int64_t{signal}}, {"deaf", deaf}});
    jobs.stop(); // first: whoever waits for a job gets an answer
    http.stop();
    log.write(LogLevel::info, "stopped");
    return deaf ? 1 : 0;
}

} // namespace server
