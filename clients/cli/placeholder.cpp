// replaced by the first real source of the CLI
