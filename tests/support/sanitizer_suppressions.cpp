// What sanitizers are to pass over in Debian's libraries. Compiled into every program of a sanitizer's build and of no other:
// the importer runs without an environment that could name a file of suppressions.

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions();

// libassimp forgets what its readers hold when a file is broken.
extern "C" const char* __lsan_default_suppressions()
{
    return "leak:libassimp\n";
}

// cpp-httplib fills a list of methods when the first request comes, as a static variable: the thread that waited for it is not
// seen to have waited, since the library is compiled without the sanitizer. What the library calls itself is passed over,
// what it calls of ours is not. The unlock at the end of its Client::stop is a jump, which looks as if our client, whose file has no
// mutex, had made it.
extern "C" const char* __tsan_default_suppressions()
{
    return "called_from_lib:libcpp-httplib.so\n"
           "mutex:clients/cli/http_client.cpp\n";
}
