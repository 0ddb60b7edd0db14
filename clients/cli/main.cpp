#include "clients/cli/command_line.h"

int main(int argc, char** argv)
{
    return clients::run_command_line(argc, argv);
}
