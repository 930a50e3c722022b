use std::process::ExitCode;

fn main() -> ExitCode {
    racer::cli::main()
}
