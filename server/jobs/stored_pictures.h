// StoredPictures: the picture of a job that succeeded, from memory or from disk; where the disk lost it, the
// job renders again.
//
// A picture is found to be lost (missing, cut off, other bytes) when it is asked for. Its job then goes back
// to the queue, and says so, rather than staying succeeded with nothing to show. What was rendered to a number
// of samples renders to the same bytes; what time stopped, to another picture as good. Where a mesh that it
// takes is gone as well, the job stays as it is, its report is still right, and the answer names the mesh.
// Threads  every function may be called from any thread.
// Errors   a lost picture is a value; StoreError is thrown where the disk cannot tell, or the job store fails.
#pragma once

#include "api/problem.h"
#include "server/jobs/job_service.h"
#include "server/jobs/live_jobs.h"
#include "server/jobs/picture_cache.h"
#include "server/jobs/result_keeper.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <string>
#include <variant>

namespace server {

class StoredPictures {
public:
    struct Rooms {
        Store& store;
        BlobStore& blobs;
        LiveJobs& live;
        PictureCache& pictures;
        ResultKeeper& keeper;
        Log log;
    };
    explicit StoredPictures(const Rooms& rooms) : rooms_(rooms) {}

    // `digest`: of the picture that the job succeeded with.
    std::variant<JobImage, api::ProblemDetails> get(const JobId& id, const std::string& digest);

private:
    PngBytes read(const std::string& digest, std::string& why_not);
    api::ProblemDetails render_again(const JobId& id, const std::string& digest, const std::string& why);

    Rooms rooms_;
};

} // namespace server
