# Makes the designs of this folder that come from R packages: Rscript make.R FRF2 RSM, the folders of the unpacked
# source packages FrF2 2.3-4 and rsm 2.10.6 (so that none of the packages they depend on is needed).
arguments <- commandArgs(trailingOnly = TRUE)
script <- sub("--file=", "", grep("--file=", commandArgs(), value = TRUE))
folder <- dirname(normalizePath(script))
version <- function(package)
  paste(read.dcf(file.path(package, "DESCRIPTION"))[1, c("Package", "Version")], collapse = " ")

write_design <- function(name, source, rows)
  writeLines(c(paste("#", source), apply(rows, 1, paste, collapse = ",")), file.path(folder, paste0(name, ".csv")))

# Fractions of least aberration: the first of each number of factors and runs in FrF2's catalogue.
load(file.path(arguments[1], "R", "sysdata.rda"))
lines <- paste("#", version(arguments[1]), "catlg, first of each: factors, runs, resolution, words of length 1, 2, ...")
for (factors in 3:25) for (runs in 2^(2:12)) {
  found <- Filter(function(each) each$nfac == factors && each$nruns == runs, catlg)
  if (length(found) == 0) next
  lines <- c(lines, paste(c(factors, runs, found[[1]]$res, found[[1]]$WLP), collapse = ","))
}
writeLines(lines, file.path(folder, "catalogue.csv"))

# Plackett-Burman designs of as many factors as possible.
source(file.path(arguments[1], "R", "utilpb.R"))
burman <- function(runs, rows)
  write_design(paste0("burman-", runs), paste0(version(arguments[1]), ": pb(", runs, ", randomize = FALSE)"), rows)
for (index in seq_along(pb.list[[1]])) {
  runs <- unlist(pb.list[[1]][index])
  rows <- pb.list[[2]][[index]]
  if (!runs %in% c(12, 16, 20)) next
  burman(runs, rbind(circ.mat(rows), rep(-1, runs - 1)))
}

# Box-Behnken designs.
for (file in list.files(file.path(arguments[2], "R"), full.names = TRUE)) source(file)
for (factors in 3:7) {
  rows <- bbd(factors, n0 = 3, block = FALSE, randomize = FALSE)[, paste0("x", 1:factors)]
  call <- paste0("bbd(", factors, ", n0 = 3, block = FALSE, randomize = FALSE)")
  write_design(paste0("behnken-rsm-", factors), paste0(version(arguments[2]), ": ", call), rows)
}
