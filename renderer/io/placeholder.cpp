// replaced by the first real source of io
