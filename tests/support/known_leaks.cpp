// What LeakSanitizer is to pass over: Debian's libassimp forgets what its readers hold when a file is broken. Compiled into
// every program that links the readers, and in no other build: the importer runs without an environment that could name a
// file of suppressions.
extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions()
{
    return "leak:libassimp\n";
}
