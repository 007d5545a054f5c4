# Computes the tables in results/ anew from the tidy tables of this export, and says what differs.
#
#   Rscript analysis/analyse.R
#
# R alone is needed, no package. Nothing of the program that made the export is used: tests are R's own, sums of squares those of its linear
# models. The tables computed are written to analysis/r/. Change what you like: this file is a beginning for an analysis of your own.

relative <- 1e-6
absolute <- 1e-9 # Figures this small differ by rounding.
confidence <- 0.95
constant <- 10 * .Machine$double.eps # Differences this small against the values are rounding, as t.test has it.
constant_squares <- 1e-20 # Of values about 0: squares this small are rounding.
eta_confidence <- 0.9 # Of a share of the variance, which has but one side.
largest_f <- 700 # F times its degrees of freedom beyond which the export has no interval.
exact_below <- 50 # From as many pairs on, or with ties or zeros, Wilcoxon's test is approximated.

script <- sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)[1])
root <- dirname(dirname(normalizePath(script)))

# Everything as text: an id may look like a number. An empty field is no value.
read <- function(name) {
  read.csv(file.path(root, name), colClasses = "character", na.strings = character(), check.names = FALSE,
    encoding = "UTF-8", fileEncoding = "UTF-8")
}

# Names of a row whose value is NA or missing are columns without a value.
mean_interval <- function(values, side) {
  low <- high <- NA
  if (length(values) > 1) {
    half <- qt((1 + confidence) / 2, length(values) - 1) * sd(values) / sqrt(length(values))
    low <- mean(values) - half
    high <- mean(values) + half
  }
  setNames(list(mean(values), low, high), paste0(c("mean_", "low_", "high_"), side))
}

paired_t <- function(first, second) {
  d <- first - second
  row <- list(difference = mean(d), df = length(d) - 1)
  if (length(d) < 2 || sd(d) / sqrt(length(d)) <= constant * abs(mean(d))) return(row)
  test <- t.test(first, second, paired = TRUE, conf.level = confidence)
  c(row, list(low_difference = test$conf.int[1], high_difference = test$conf.int[2], t = unname(test$statistic),
    p = test$p.value, dz = mean(d) / sd(d)))
}

signed_rank <- function(first, second) {
  d <- first - second
  kept <- d[d != 0]
  if (length(kept) == 0) return(list(v = 0, method_wilcoxon = "exact"))
  exact <- length(kept) == length(d) && !any(duplicated(abs(kept))) && length(kept) < exact_below
  test <- suppressWarnings(wilcox.test(d, exact = exact, correct = TRUE))
  v <- unname(test$statistic)
  total <- length(kept) * (length(kept) + 1) / 2
  list(v = v, p_wilcoxon = test$p.value, method_wilcoxon = if (exact) "exact" else "normal",
    rank_biserial = (2 * v - total) / total)
}

# A test without a p has none, and counts in the family.
holm <- function(p) p.adjust(p, "holm", n = length(p))

number_of <- function(row, name) if (is.null(row[[name]])) NA_real_ else as.numeric(row[[name]])

# What was asked with a number, in the order first met: its place, and its name (the id where that is of one place alone).
measures <- function(rows, value) {
  answered <- rows[rows[[value]] != "", ]
  places <- unique(answered[, c("task", "questionnaire", "id")])
  times <- table(places$id)
  places$of <- ifelse(times[places$id] == 1, places$id, paste(places$task, places$questionnaire, places$id, sep = "/"))
  places
}

of_place <- function(rows, place) {
  rows[rows$task == place$task & rows$questionnaire == place$questionnaire & rows$id == place$id, ]
}

# The mean of what counts, of each (who) under each condition: a matrix, NA where there is none.
means_of <- function(rows, value, everyone, conditions) {
  counted <- rows[rows$excluded == "" & rows[[value]] != "", ]
  tapply(as.numeric(counted[[value]]), list(factor(counted$who, everyone), factor(counted$condition, conditions)), mean)
}

# One family: each of the series under two conditions, first - second.
compared <- function(series, first, second) {
  rows <- lapply(series, function(one) {
    a <- one$means[, first]
    b <- one$means[, second]
    both <- !is.na(a) & !is.na(b)
    a <- unname(a[both])
    b <- unname(b[both])
    row <- list(of = one$of, about = one$about, unit = one$unit, first = first, second = second, n = sum(both))
    if (!any(both)) return(row)
    c(row, mean_interval(a, "first"), mean_interval(b, "second"), paired_t(a, b), signed_rank(a, b))
  })
  adjusted <- holm(vapply(rows, number_of, 0, "p"))
  ranks_adjusted <- holm(vapply(rows, number_of, 0, "p_wilcoxon"))
  Map(function(row, p, v) c(row, list(p_holm = p, p_wilcoxon_holm = v)), rows, adjusted, ranks_adjusted)
}

effect <- function(squares, error, df, epsilon, scale) {
  row <- list(df1 = df[1], df2 = df[2])
  if (df[2] < 1 || error <= constant_squares * scale) return(row)
  f <- squares / df[1] / (error / df[2])
  row <- c(row, list(f = f, p = pf(f, df[1], df[2], lower.tail = FALSE), partial_eta_squared = squares / (squares + error)))
  if (!is.na(epsilon)) {
    corrected <- pf(f, epsilon * df[1], epsilon * df[2], lower.tail = FALSE)
    row <- c(row, list(epsilon = epsilon, p_corrected = corrected))
  }
  if (f * df[1] > largest_f) return(row)
  share_at <- function(share) {
    if (pf(f, df[1], df[2]) <= share) return(0)
    below <- function(ncp) pf(f, df[1], df[2], ncp) - share
    ncp <- uniroot(below, c(0, 2 * largest_f), tol = 1e-13, maxiter = 10000)$root
    ncp / (ncp + sum(df) + 1)
  }
  c(row, list(low_eta = share_at((1 + eta_confidence) / 2), high_eta = share_at((1 - eta_confidence) / 2)))
}

# Effects of conditions, cohorts and both, type III: differences of linear models with sum-coded cohorts, contrast by contrast.
variance_analysis <- function(values, cohort) {
  k <- ncol(values)
  n <- nrow(values)
  groups <- nlevels(cohort)
  scale <- sum(values^2)
  coded <- if (groups > 1) model.matrix(~cohort, contrasts.arg = list(cohort = "contr.sum"))[, -1, drop = FALSE]
  parts <- function(y) {
    if (groups < 2) {
      full <- deviance(lm(y ~ 1))
      return(c(mean = sum(y^2) - full, between = 0, error = full))
    }
    full <- deviance(lm(y ~ coded))
    c(mean = deviance(lm(y ~ 0 + coded)) - full, between = deviance(lm(y ~ 1)) - full, error = full)
  }
  effects <- list()
  if (k > 1) {
    helmert <- contr.helmert(k)
    contrasts <- values %*% sweep(helmert, 2, sqrt(colSums(helmert^2)), "/")
    sums <- rowSums(apply(contrasts, 2, parts))
    epsilon <- NA
    if (sums[["error"]] > constant_squares * scale) {
      residuals <- residuals(if (groups > 1) lm(contrasts ~ cohort) else lm(contrasts ~ 1))
      covariance <- crossprod(residuals)
      epsilon <- sum(diag(covariance))^2 / ((k - 1) * sum(covariance^2))
    }
    effects$conditions <- effect(sums[["mean"]], sums[["error"]], c(k - 1, (n - groups) * (k - 1)), epsilon, scale)
  }
  if (groups > 1) {
    main <- parts(rowSums(values) / sqrt(k))
    effects$cohorts <- effect(main[["between"]], main[["error"]], c(groups - 1, n - groups), NA, scale)
    if (k > 1) {
      df <- c((groups - 1) * (k - 1), (n - groups) * (k - 1))
      effects[["conditions and cohorts"]] <- effect(sums[["between"]], sums[["error"]], df, epsilon, scale)
    }
  }
  effects
}

# Friedman's test of the conditions; with one condition, Kruskal and Wallis's of the cohorts.
rank_test <- function(values, cohort) {
  k <- ncol(values)
  df <- (if (k > 1) k else nlevels(cohort)) - 1
  # With nothing but ties there is nothing to rank.
  spread <- if (k > 1) any(apply(values, 1, function(row) length(unique(row)) > 1)) else length(unique(c(values))) > 1
  if (!spread) return(list(df_ranks = df))
  test <- if (k > 1) friedman.test(values) else kruskal.test(c(values), cohort)
  chi <- unname(test$statistic)
  size <- if (k > 1) chi / (nrow(values) * df) else chi / (nrow(values) - 1)
  list(chi_squared = chi, df_ranks = df, p_ranks = test$p.value, effect_ranks = size)
}

# All conditions and cohorts at once, an effect a row; one family.
overall <- function(rows, value, conditions, cohort_of) {
  places <- measures(rows, value)
  found <- lapply(seq_len(nrow(places)), function(index) {
    own <- of_place(rows, places[index, ])
    everyone <- sort(unique(own$who))
    means <- means_of(own, value, everyone, conditions)
    complete <- rowSums(is.na(means)) == 0
    cohort <- factor(cohort_of[everyone])
    one <- list(of = places$of[index], n = sum(complete), effects = list(), ranks = list())
    if (any(table(cohort[complete]) == 0)) return(one)
    values <- unname(means[complete, , drop = FALSE])
    one$effects <- variance_analysis(values, cohort[complete])
    if (length(conditions) > 1 || nlevels(cohort) > 1) one$ranks <- rank_test(values, cohort[complete])
    one
  })
  tested <- function(one) {
    main <- if (is.null(one$effects$conditions)) one$effects$cohorts else one$effects$conditions
    p <- number_of(main, "p_corrected")
    if (is.na(p)) number_of(main, "p") else p
  }
  adjusted <- holm(vapply(found, tested, 0))
  ranks_adjusted <- holm(vapply(found, function(one) number_of(one$ranks, "p_ranks"), 0))
  table <- list()
  for (index in seq_along(found)) {
    one <- found[[index]]
    for (label in names(one$effects)) {
      first <- if (label == names(one$effects)[1]) {
        c(one$ranks, list(p_holm = adjusted[index], p_ranks_holm = ranks_adjusted[index]))
      }
      table <- c(table, list(c(list(of = one$of, effect = label, n = one$n), one$effects[[label]], first)))
    }
  }
  table
}

# Work of the page per frame, over all trials of a task under a condition.
frame_times <- function(rows, trials) {
  trial_of <- function(of) paste(of$participant, of$task, of$block, of$run, of$attempt, of$repetition, of$condition)
  rows$missed <- trials$missed_frames[match(trial_of(rows), trial_of(trials))]
  rows <- rows[rows$excluded == "", ]
  groups <- unique(rows[, c("task", "condition", "stage")])
  groups <- groups[order(groups$stage != "frame"), ]
  lapply(seq_len(nrow(groups)), function(index) {
    group <- groups[index, ]
    own <- rows[rows$task == group$task & rows$condition == group$condition & rows$stage == group$stage, ]
    counts <- as.numeric(own$count)
    list(task = group$task, condition = group$condition, stage = group$stage, trials = nrow(own), frames = sum(counts),
      min = min(as.numeric(own$min)), max = max(as.numeric(own$max)), mean = sum(counts * as.numeric(own$mean)) / sum(counts),
      worst_p95 = max(as.numeric(own$p95)), missed = sum(as.numeric(own$missed)))
  })
}

all_tables <- function() {
  said <- read("conditions.csv")
  conditions <- said$id[said$compared == "condition"]
  people <- read("participants.csv")
  cohort_of <- setNames(people$cohort, people$participant)
  # What comes first in the plan is what others are compared with.
  pairs <- if (length(conditions) > 1) combn(conditions, 2, simplify = FALSE) else list()
  about <- read("questions.csv")
  about <- setNames(about$about, paste(about$questionnaire, about$question))
  labels <- read("scale-definitions.csv")
  labels <- setNames(labels$label, paste(labels$questionnaire, labels$scale))
  tables <- list()
  kinds <- list(
    list(name = "answers", file = "answers.csv", id = "question", value = "answer", words = about),
    list(name = "scales", file = "scales.csv", id = "scale", value = "value", words = labels)
  )
  for (kind in kinds) {
    rows <- read(kind$file)
    rows$id <- rows[[kind$id]]
    rows$who <- rows$participant
    places <- measures(rows, kind$value)
    series <- lapply(seq_len(nrow(places)), function(index) {
      place <- places[index, ]
      own <- of_place(rows, place)
      list(of = place$of, unit = "answer", about = unname(kind$words[paste(place$questionnaire, place$id)]),
        means = means_of(own, kind$value, sort(unique(own$who)), conditions))
    })
    tables[[paste0(kind$name, "-compared")]] <- do.call(c, lapply(pairs, function(pair) compared(series, pair[2], pair[1])))
    shown <- length(conditions) > 2 || any(said$compared == "cohort")
    tables[[paste0(kind$name, "-overall")]] <- if (shown) overall(rows, kind$value, conditions, cohort_of) else list()
  }
  trials <- read("trials.csv")
  counted <- trials[trials$excluded == "", ]
  # The members of a group report one and the same score.
  once <- counted[!duplicated(counted[, c("task", "group", "condition", "repetition")], fromLast = TRUE), ]
  once$who <- as.numeric(once$group)
  scores <- list()
  for (pair in pairs) {
    for (unit in c("points", "percent")) {
      series <- lapply(unique(trials$task), function(task) {
        own <- once[once$task == task, ]
        value <- if (unit == "points") "score" else "percent"
        list(of = task, unit = unit, about = "", means = means_of(own, value, sort(unique(own$who)), conditions))
      })
      scores <- c(scores, compared(series, pair[2], pair[1]))
    }
  }
  tables[["scores-compared"]] <- scores
  tables[["frame-times"]] <- frame_times(read("frame-times.csv"), trials)
  tables
}

# As the table has it: 17 digits give every number back.
as_text <- function(value) {
  if (is.null(value) || length(value) == 0 || is.na(value)) "" else if (is.numeric(value)) sprintf("%.17g", value) else value
}

# Why a cell of the export is not what was computed; NULL: it is.
difference <- function(ours, theirs) {
  said <- as_text(ours)
  if (said == theirs) return(NULL)
  if (is.numeric(ours) && said != "" && theirs != "") {
    if (abs(ours - as.numeric(theirs)) <= relative * abs(as.numeric(theirs)) + absolute) return(NULL)
  }
  sprintf('"%s" in the export, "%s" here', theirs, said)
}

out <- file.path(root, "analysis", "r")
dir.create(out, showWarnings = FALSE)
wrong <- 0
tables <- all_tables()
files <- c("answers-compared", "answers-overall", "scales-compared", "scales-overall", "scores-compared", "frame-times")
for (name in files) {
  table <- tables[[name]]
  theirs <- read(sprintf("results/%s.csv", name))
  columns <- setdiff(names(theirs), "simulated")
  cells <- do.call(rbind, lapply(table, function(row) vapply(columns, function(column) as_text(row[[column]]), "")))
  cells <- if (is.null(cells)) matrix("", 0, length(columns), dimnames = list(NULL, columns)) else cells
  write.csv(cells, file.path(out, paste0(name, ".csv")), row.names = FALSE, fileEncoding = "UTF-8")
  complaints <- character()
  if (nrow(theirs) != length(table)) complaints <- sprintf("%d rows in the export, %d here", nrow(theirs), length(table))
  for (number in seq_len(min(nrow(theirs), length(table)))) {
    for (column in columns) {
      # Text of a formula's look has an apostrophe of the export's before it.
      said <- difference(table[[number]][[column]], sub("^'", "", theirs[[column]][number]))
      if (!is.null(said)) complaints <- c(complaints, sprintf("line %d, %s: %s", number + 1, column, said))
    }
  }
  wrong <- wrong + length(complaints)
  verdict <- if (length(complaints) == 0) "as computed here" else sprintf("%d differences", length(complaints))
  cat(sprintf("results/%s.csv: %d rows, %s\n", name, nrow(theirs), verdict))
  cat(sprintf("  %s\n", head(complaints, 20)), sep = "")
}
quit(status = if (wrong > 0) 1 else 0)
